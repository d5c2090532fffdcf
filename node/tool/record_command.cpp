// palpate record: messages of the bus into a file.
#include <iostream>
#include <memory>

#include "node/clock.h"
#include "node/endpoint.h"
#include "node/stop_signals.h"
#include "node/tool/command.h"
#include "node/tool/recording.h"

namespace palpate {
namespace {

struct RecordCommand {
  std::string file;
  Connection connection{std::string(kDefaultResultsEndpoint), "", ""};
  std::string contacts;
  double seconds = 0.0;
  std::uint64_t count = 0;
};

int run(const RecordCommand& command) {
  const auto curve = curve_of(command.connection);
  if (!curve) {
    return complain(curve.error, kUsage);
  }
  const bool from_probes = !command.contacts.empty();
  const Result<Endpoint> endpoint =
      from_probes ? parse_endpoint(command.contacts, /*bind_by_default=*/true)
                  : parse_endpoint(command.connection.endpoint, /*bind_by_default=*/false);
  if (!endpoint) {
    return complain(endpoint.error, kUsage);
  }
  const int stop_fd = take_stop_signals();
  zmq::context_t context(1);
  SocketSettings settings;
  settings.receive_high_water_mark = 100000;  // a disk may pause
  settings.curve_client = *curve.value;
  zmq::socket_t socket = make_socket(context, zmq::socket_type::sub, settings);
  socket.set(zmq::sockopt::subscribe, "");
  if (const std::string error = attach(socket, *endpoint.value); !error.empty()) {
    return complain(error, kFailed);
  }
  RecordingWriter writer;
  if (const std::string error = writer.open(command.file); !error.empty()) {
    return complain(error, kFailed);
  }
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(command.seconds);
  std::vector<zmq::pollitem_t> items{{socket.handle(), 0, ZMQ_POLLIN, 0}};
  TwoFrames frames;
  std::uint64_t recorded = 0;
  v1::RecordedMessage message;
  while (!stop_requested(stop_fd) &&
         (command.seconds == 0.0 || std::chrono::steady_clock::now() < end) &&
         (command.count == 0 || recorded < command.count)) {
    constexpr int kStepMs = 50;
    poll(items, kStepMs);
    while ((command.count == 0 || recorded < command.count) && receive_now(socket, frames)) {
      message.set_received_ns(unix_time_ns());
      message.set_topic(frames.topic.to_string());
      message.set_payload(frames.payload.to_string());
      if (!writer.write(message)) {
        return complain(command.file + ": cannot be written", kFailed);
      }
      ++recorded;
    }
  }
  std::cerr << command.file << ": " << recorded << " messages\n";
  return kDone;
}

}  // namespace

void add_record_command(CLI::App& app, int& exit_code) {
  auto record = std::make_shared<RecordCommand>();
  CLI::App* command = app.add_subcommand(
      "record",
      "Record messages into a new file, to be replayed: the recognizer's results, or with --contacts,\n"
      "in the recognizer's place, what the probes publish. Ends by SIGINT, --seconds or --count.");
  command->add_option("FILE", record->file, "File to make")->required()->type_name("");
  add_connection_flags(*command, "--results", "The recognizer's results endpoint",
                       record->connection);
  command
      ->add_option("--contacts", record->contacts,
                   "Bind here, as the recognizer would, and record the probes instead")
      ->type_name("ENDPOINT");
  command->add_option("--seconds", record->seconds, "Record so long; 0 = for ever [s]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->type_name("S");
  command->add_option("--count", record->count, "Record so many messages; 0 = any number")
      ->capture_default_str()
      ->type_name("N");
  command->callback([record, &exit_code] { exit_code = run(*record); });
}

}  // namespace palpate
