// palpate record: messages of the bus into a file.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <map>
#include <memory>
#include <optional>

#include "node/files/counted.h"
#include "node/files/recording.h"
#include "node/intake/sequence_tracker.h"
#include "node/process/clock.h"
#include "node/process/stop_signals.h"
#include "node/tool/commands/command.h"
#include "node/tool/commands/listening_place.h"
#include "node/tool/commands/live/topic_count.h"
#include "node/tool/text/progress.h"

namespace palpate {
namespace {

struct RecordCommand {
  std::string file;
  Connection connection{std::string(kDefaultResultsEndpoint), "", ""};
  std::string contacts;
  std::string allow_clients;
  bool insecure = false;
  double seconds = 0.0;
  std::uint64_t count = 0;
};

/// Unix time, by a clock that never steps back.
class SteadyUnixClock {
 public:
  std::int64_t now_ns() const {
    return unix_start_ns_ +
           std::chrono::nanoseconds(std::chrono::steady_clock::now() - steady_start_).count();
  }

 private:
  std::int64_t unix_start_ns_ = unix_time_ns();
  std::chrono::steady_clock::time_point steady_start_ = std::chrono::steady_clock::now();
};

int open(const RecordCommand& command, ListeningPlace& place) {
  if (!command.contacts.empty()) {
    if (!command.connection.recognizer_key.empty()) {
      return complain(
          "--curve-server-key: with --contacts the recorder is the server: give "
          "--curve-secret-key and --allow-clients",
          kUsage);
    }
    if (!command.connection.own_key.empty() && command.allow_clients.empty()) {
      return complain("--curve-secret-key requires --allow-clients with --contacts", kUsage);
    }
    return place.open_as_recognizer(
        {command.contacts, command.connection.own_key, command.allow_clients, command.insecure});
  }
  if (!command.connection.own_key.empty() && command.connection.recognizer_key.empty()) {
    return complain("--curve-secret-key requires --curve-server-key", kUsage);
  }
  const auto curve = curve_of(command.connection);
  if (!curve) {
    return complain(curve.error, kUsage);
  }
  return place.open_as_client(command.connection.endpoint, *curve.value);
}

int run(const RecordCommand& command) {
  const int stop_fd = take_stop_signals();
  ListeningPlace place;
  if (const int code = open(command, place); code != kDone) {
    return code;
  }
  RecordingWriter writer;
  if (const std::string error = writer.open(command.file); !error.empty()) {
    return complain(error, kFailed);
  }
  using Clock = std::chrono::steady_clock;
  std::optional<Clock::time_point> end;
  if (command.seconds > 0.0) {
    end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                             std::chrono::duration<double>(command.seconds));
  }
  const SteadyUnixClock clock;
  RecordedMessage message;
  std::uint64_t recorded = 0;
  std::map<std::string, SequenceTracker> orders;  // by topic
  std::string why;                                // the file cannot be written
  Progress progress;
  progress.tell([&] { return command.file + ": waiting for messages"; });
  place.listen(stop_fd, end, [&](const TwoFrames& frames) {
    message.received_ns = clock.now_ns();
    message.frame_count = static_cast<std::uint32_t>(frames.frame_count);
    message.topic = frames.topic.to_string();
    message.payload = frames.payload.to_string();
    why = writer.write(message);
    recorded += why.empty() ? 1 : 0;
    constexpr std::size_t kMostTopics = 10'000;  // a bound of memory: of any others nothing is told
    const bool is_told = orders.size() < kMostTopics || orders.count(message.topic) > 0;
    if (v1::Header header;
        is_told && message.frame_count == 2 && header_of(message.payload, header)) {
      orders[message.topic].take(header.epoch(), header.seq());
    }
    progress.tell([&] { return command.file + ": " + counted(recorded, "message"); });
    return why.empty() && (command.count == 0 || recorded < command.count);
  });
  progress.end();
  if (!why.empty()) {
    return complain(why, kFailed);
  }
  const std::string& endpoint =
      command.contacts.empty() ? command.connection.endpoint : command.contacts;
  std::cerr << command.file << ": " << counted(recorded, "message");
  if (recorded == 0) {
    std::cerr << ": nothing was heard on " << endpoint;
  }
  std::uint64_t missing = 0;
  for (const auto& [topic, order] : orders) missing += order.missing();
  if (missing > 0) {
    std::cerr << "; " << counted(missing, "message")
              << " missing between them, as their numbers show";
  }
  std::cerr << "\n";
  if (const std::string refusal = place.refusal(); !refusal.empty()) {
    return complain("the recognizer at " + endpoint + " " + refusal, kFailed);
  }
  return kDone;
}

}  // namespace

void add_record_command(CLI::App& app, int& exit_code) {
  auto record = std::make_shared<RecordCommand>();
  CLI::App* command = app.add_subcommand(
      "record",
      "Record messages into a new file, to be replayed: the recognizer's results, or with "
      "--contacts,\n"
      "in the recognizer's place, what the probes publish. Ends by SIGINT, --seconds or --count.");
  command->add_option("FILE", record->file, "File to make")->required()->type_name("");
  const KeyFlags keys = add_connection_flags(
      *command, "--results", "The recognizer's results endpoint", record->connection);
  // In the recognizer's place its secret key goes with --allow-clients: see open().
  keys.own->remove_needs(keys.recognizer);
  CLI::Option* contacts =
      command->add_option("--contacts", record->contacts,
                          "Bind here, as the recognizer would, and record the probes instead");
  contacts->type_name("ENDPOINT");
  command
      ->add_option("--allow-clients", record->allow_clients,
                   "CURVE with --contacts: file of the public keys that may connect")
      ->check(key_file_name())
      ->needs(contacts)
      ->needs(keys.own)
      ->type_name("FILE");
  command->add_flag("--insecure", record->insecure,
                    "With --contacts: permit a bind beyond this machine without CURVE");
  command->add_option("--seconds", record->seconds, "Record so long; 0 = for ever [s]")
      ->check(seconds_to_wait())
      ->capture_default_str()
      ->type_name("S");
  command->add_option("--count", record->count, "Record so many messages; 0 = any number")
      ->check(counting_number())
      ->capture_default_str()
      ->type_name("N");
  command->callback([record, &exit_code] { exit_code = run(*record); });
}

}  // namespace palpate
