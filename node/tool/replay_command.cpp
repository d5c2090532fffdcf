// palpate replay: the contacts of a recording or of a CSV file, published as by their probes.
#include <poll.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>

#include "node/client/contact_publisher.h"
#include "node/clock.h"
#include "node/csv/contact_csv.h"
#include "node/stop_signals.h"
#include "node/tool/command.h"
#include "node/tool/contact_groups.h"
#include "node/tool/recording.h"
#include "node/topics.h"

namespace palpate {
namespace {

struct ReplayCommand {
  std::string file;
  Connection connection{std::string(kDefaultContactsEndpoint), "", ""};
  double speed = 1.0;
  bool fast = false;
  bool keep_objects = false;
  double wait_s = 10.0;
  double rate_hz = 250.0;
  std::size_t batch_samples = 10;
  double sigma_m = 0.0;
};

struct TimedMessage {
  std::int64_t due_ns = 0;  ///< on the recording's clock
  std::string probe;
  v1::ContactBatch batch;
};

/// `is_whole` receives whether the file goes on to its end.
Result<std::vector<TimedMessage>> from_recording(const std::string& path, bool* is_whole) {
  using Messages = Result<std::vector<TimedMessage>>;
  const Result<Recording> recording = read_recording(path);
  if (!recording) {
    return Messages::fail(recording.error);
  }
  *is_whole = recording.value->truncated_at == 0;
  if (!*is_whole) {
    complain(path + ": breaks off at byte " + std::to_string(recording.value->truncated_at) +
                 "; what is before it is replayed",
             kDone);
  }
  std::vector<TimedMessage> messages;
  std::size_t number = 0;
  for (const v1::RecordedMessage& recorded : recording.value->messages) {
    ++number;
    const std::optional<Topic> topic = parse_topic(recorded.topic());
    if (!topic || topic->kind != TopicKind::Contact) {
      continue;
    }
    TimedMessage message{recorded.received_ns(), std::string(topic->name), {}};
    if (!message.batch.ParseFromString(recorded.payload())) {
      return Messages::fail(path + ": message " + std::to_string(number) + ": no ContactBatch");
    }
    messages.push_back(std::move(message));
  }
  if (messages.empty()) {
    return Messages::fail(path + ": no contact messages in it (record them with --contacts)");
  }
  return Messages::ok(std::move(messages));
}

v1::MaterialSide to_wire_side(MaterialSide side) {
  return side == MaterialSide::Left    ? v1::MATERIAL_SIDE_LEFT
         : side == MaterialSide::Right ? v1::MATERIAL_SIDE_RIGHT
                                       : v1::MATERIAL_SIDE_UNSPECIFIED;
}

/// Batches of consecutive samples of one patch, due with their last one: by its stamp, or after so many
/// sample periods where the file has no stamps.
Result<std::vector<TimedMessage>> from_csv(const ReplayCommand& command) {
  using Messages = Result<std::vector<TimedMessage>>;
  const Result<ContactTable> table = read_contact_csv(command.file);
  if (!table) {
    return Messages::fail(table.error);
  }
  // Times may count from 0.
  const bool stamped = std::any_of(
      table.value->rows.begin(), table.value->rows.end(),
      [](const ContactRow& row) { return row.sample.stamp_ns > 0; });
  const double period_ns = 1e9 / command.rate_hz;
  std::vector<TimedMessage> messages;
  std::map<std::string, std::int64_t> taken;  // samples, by probe
  for (const ContactGroup& group : contact_groups(command.file, *table.value)) {
    for (const ContactRun& run : group.runs) {
      const std::string& probe = group.probes[run.context.probe];
      for (std::size_t i = 0; i < run.samples.size(); ++i) {
        if (i % command.batch_samples == 0) {
          messages.push_back({0, probe, {}});
          v1::ContactBatch& batch = messages.back().batch;
          batch.set_group(group.name);
          batch.set_object(group.object);
          batch.set_patch(run.context.patch);
          batch.set_tip_radius_m(run.context.tip_radius_m);
          batch.set_material_side(to_wire_side(run.context.material_side));
        }
        const ContactSample& from = run.samples[i];
        v1::ContactSample& to = *messages.back().batch.add_samples();
        to.set_x_m(from.position_m.x());
        to.set_y_m(from.position_m.y());
        to.set_sigma_m(from.sigma_m > 0.0 ? from.sigma_m : command.sigma_m);
        to.set_stamp_ns(stamped ? from.stamp_ns
                                : std::llround(period_ns * static_cast<double>(++taken[probe])));
        messages.back().due_ns = to.stamp_ns();
      }
    }
  }
  std::stable_sort(messages.begin(), messages.end(),
                   [](const TimedMessage& a, const TimedMessage& b) { return a.due_ns < b.due_ns; });
  return messages.empty() ? Messages::fail(command.file + ": no samples")
                          : Messages::ok(std::move(messages));
}

/// Sleeps until then; true where a stop is asked for.
bool sleep_until(std::int64_t unix_ns, int stop_fd) {
  for (;;) {
    const std::int64_t left = unix_ns - unix_time_ns();
    const std::int64_t wait = std::clamp<std::int64_t>(left, 0, 100'000'000);
    const timespec timeout{0, wait};
    pollfd stop{stop_fd, POLLIN, 0};
    if (::ppoll(&stop, 1, &timeout, nullptr) > 0) {
      return true;
    }
    if (left <= 0) {
      return false;
    }
  }
}

int run(const ReplayCommand& command) {
  const auto curve = curve_of(command.connection);
  if (!curve) {
    return complain(curve.error, kUsage);
  }
  bool is_whole = true;
  Result<std::vector<TimedMessage>> messages =
      is_recording(command.file) ? from_recording(command.file, &is_whole) : from_csv(command);
  if (!messages) {
    return complain(messages.error, kUsage);
  }
  const int stop_fd = take_stop_signals();
  client::ContactPublisherOptions options;
  options.endpoint = command.connection.endpoint;
  options.curve = *curve.value;
  options.high_water_mark = command.fast ? 100000 : 1000;
  client::ContactPublisher publisher(options);
  const auto give_up =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(command.wait_s);
  while (!publisher.wait_for_recognizer(std::chrono::milliseconds(50))) {
    if (stop_requested(stop_fd)) {
      return kDone;
    }
    if (std::chrono::steady_clock::now() >= give_up) {
      return complain("no recognizer listens at " + command.connection.endpoint, kFailed);
    }
  }
  // Objects of the recording become new ones: a second replay is another touch of the part.
  const auto first_object = static_cast<std::uint64_t>(unix_time_ns() / 1'000'000);
  std::map<std::uint64_t, std::uint64_t> objects;
  const std::int64_t start_ns = unix_time_ns();
  const std::int64_t recorded_start_ns = messages.value->front().due_ns;
  const double scale = command.fast ? 0.0 : 1.0 / command.speed;
  std::uint64_t refused = 0;
  std::uint64_t samples = 0;
  for (TimedMessage& message : *messages.value) {
    const auto replayed = [&](std::int64_t recorded_ns) {
      return start_ns +
             std::llround(scale * static_cast<double>(recorded_ns - recorded_start_ns));
    };
    if (sleep_until(replayed(message.due_ns), stop_fd)) {
      break;
    }
    for (v1::ContactSample& sample : *message.batch.mutable_samples()) {
      sample.set_stamp_ns(command.fast ? unix_time_ns() : replayed(sample.stamp_ns()));
    }
    if (!command.keep_objects) {
      const auto number = objects.try_emplace(message.batch.object(), first_object + objects.size());
      message.batch.set_object(number.first->second);
    }
    samples += static_cast<std::uint64_t>(message.batch.samples_size());
    refused += publisher.publish(message.probe, message.batch) ? 0 : 1;
  }
  std::cerr << command.file << ": " << messages.value->size() << " messages, " << samples
            << " samples";
  std::cerr << (refused > 0 ? ", " + std::to_string(refused) + " not taken\n" : "\n");
  return refused == 0 && is_whole ? kDone : kFailed;
}

}  // namespace

void add_replay_command(CLI::App& app, int& exit_code) {
  auto replay = std::make_shared<ReplayCommand>();
  CLI::App* command = app.add_subcommand(
      "replay",
      "Publish the contacts of a recording (palpate record --contacts) or of a CSV file as their probes\n"
      "would: at their own pace, stamped anew, as new objects.");
  command->add_option("FILE", replay->file, "Recording or CSV file")->required()->type_name("");
  add_connection_flags(*command, "--contacts", "The recognizer's contacts endpoint",
                       replay->connection);
  command->add_option("--speed", replay->speed, "Times as fast as recorded")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->type_name("FACTOR");
  command->add_flag("--fast", replay->fast, "As fast as possible");
  command->add_flag("--keep-objects", replay->keep_objects, "Keep the recorded object numbers");
  command->add_option("--wait", replay->wait_s, "Seconds to wait for a recognizer before giving up")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->type_name("S");
  command->add_option("--rate", replay->rate_hz, "CSV without stamps: samples a second of each probe")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->type_name("HZ");
  command->add_option("--batch", replay->batch_samples, "CSV: samples of a message")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str()
      ->type_name("N");
  command->add_option("--sigma", replay->sigma_m, "CSV: noise of samples that bring none; 0 = not known [m]")
      ->check(CLI::Range(0.0, 1e3))
      ->capture_default_str()
      ->type_name("METRES");
  command->callback([replay, &exit_code] { exit_code = run(*replay); });
}

}  // namespace palpate
