// palpate replay: the contacts of a recording or of a CSV file, published as by their probes.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "node/client/contact_publisher.h"
#include "node/files/counted.h"
#include "node/files/recording.h"
#include "node/intake/sequence_tracker.h"
#include "node/process/clock.h"
#include "node/process/stop_signals.h"
#include "node/tool/commands/command.h"
#include "node/tool/commands/file_flags.h"
#include "node/tool/commands/live/sample_times.h"
#include "node/tool/contact_groups.h"
#include "node/tool/text/progress.h"
#include "node/wire/convert.h"
#include "node/wire/topics.h"

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
  FileFlags flags;
  std::vector<std::string> for_points;  ///< options given that a recording has no use for
};

struct TimedMessage {
  std::int64_t due_ns = 0;  ///< on the recording's clock
  std::string probe;
  std::uint64_t lost_before = 0;  ///< messages of its probe
  v1::ContactBatch batch;
};

/// Messages one after the other; false at the end.
using Messages = std::function<bool(TimedMessage&)>;

/// The contact messages of a recording, read as they are needed.
class RecordedContacts {
 public:
  explicit RecordedContacts(const std::string& path) : path_(path) {}

  std::string open() {
    if (std::string error = reader_.open(path_); !error.empty()) {
      return error;
    }
    has_first_ = read(first_);
    return has_first_ ? "" : path_ + ": no contact messages in it (record them with --contacts)";
  }

  /// `message.lost_before`: how many of its probe's messages before it are not in the recording.
  bool next(TimedMessage& message) {
    if (!has_first_) {
      return read(message);
    }
    has_first_ = false;
    message = std::move(first_);
    return true;
  }

  /// Says what has been left out; false where something was damaged.
  bool report() const {
    const bool whole = reader_.damaged() == 0 && !reader_.breaks_off();
    if (reader_.damaged() > 0) {
      complain(path_ + ": damaged in " + std::to_string(reader_.damaged()) + " places, " +
                   std::to_string(reader_.skipped_bytes()) + " bytes skipped",
               kDone);
    }
    if (reader_.breaks_off()) {
      complain(path_ + ": breaks off within a message; what is before it is replayed", kDone);
    }
    if (malformed_ > 0) {
      complain(path_ + ": " + std::to_string(malformed_) +
                   " messages left out: recorded as they came, they are no ContactBatch",
               kDone);
    }
    if (missing_ > 0) {
      complain(path_ + ": " + counted(missing_, "message") +
                   " of the probes not in it, as their numbers show: missing in what is published "
                   "too",
               kDone);
    }
    if (out_of_order_ > 0) {
      complain(path_ + ": " + counted(out_of_order_, "message") +
                   " left out: not newer than one before, which a recognizer rejects",
               kDone);
    }
    return whole;
  }

 private:
  bool read(TimedMessage& message) {
    while (reader_.next(recorded_)) {
      const std::optional<Topic> topic = parse_topic(recorded_.topic);
      if (recorded_.frame_count == 2 && topic && topic->kind != TopicKind::Contact) {
        continue;
      }
      if (recorded_.frame_count != 2 || !topic ||
          !message.batch.ParseFromString(recorded_.payload)) {
        ++malformed_;
        continue;
      }
      const v1::Header& header = message.batch.header();
      SequenceTracker& order = orders_[std::string(topic->name)];
      const std::uint64_t missing = order.missing();
      if (!is_news(order.take(header.epoch(), header.seq()))) {
        ++out_of_order_;
        continue;
      }
      message.due_ns = recorded_.received_ns;
      message.probe = topic->name;
      message.lost_before = order.missing() - missing;
      missing_ += message.lost_before;
      return true;
    }
    return false;
  }

  std::string path_;
  RecordingReader reader_;
  RecordedMessage recorded_;
  TimedMessage first_;
  bool has_first_ = false;
  std::uint64_t malformed_ = 0;
  std::map<std::string, SequenceTracker> orders_;  ///< by probe
  std::uint64_t missing_ = 0;
  std::uint64_t out_of_order_ = 0;
};

/// Batches of consecutive samples of one patch, due with their last one: by its stamp, or after so
/// many sample periods where the file has no stamps.
Result<std::vector<TimedMessage>> from_csv(const ReplayCommand& command) {
  using Batches = Result<std::vector<TimedMessage>>;
  const Result<ContactFile> file = read_contact_file(command.file, options_of(command.flags));
  if (!file) {
    return Batches::fail(file.error);
  }
  const ContactTable* const table = &file.value->table;
  for (const std::string& note : file.value->notes) complain(command.file + ": " + note, kDone);
  SampleTimes times(*table, command.rate_hz);
  std::vector<TimedMessage> messages;
  for (const ContactGroup& group : contact_groups(command.file, *table)) {
    times.begin_group();
    for (const ContactRun& run : group.runs) {
      times.begin_run(run);
      const std::string& probe = group.probes[run.context.probe];
      for (std::size_t i = 0; i < run.samples.size(); ++i) {
        if (i % command.batch_samples == 0) {
          messages.push_back({0, probe, 0, {}});
          v1::ContactBatch& batch = messages.back().batch;
          batch.set_group(group.name);
          batch.set_object(group.object);
          batch.set_patch(run.context.patch);
          batch.set_tip_radius_m(run.context.tip_radius_m);
          batch.set_material_side(to_wire(run.context.material_side));
        }
        const ContactSample& from = run.samples[i];
        v1::ContactSample& to = *messages.back().batch.add_samples();
        to.set_x_m(from.position_m.x());
        to.set_y_m(from.position_m.y());
        to.set_sigma_m(from.sigma_m > 0.0 ? from.sigma_m : command.sigma_m);
        if (!run.details.empty()) to_wire(run.details[i], to);
        to.set_stamp_ns(times.stamp_ns(probe, from));
        messages.back().due_ns = times.due_ns();
      }
    }
  }
  std::stable_sort(
      messages.begin(), messages.end(),
      [](const TimedMessage& a, const TimedMessage& b) { return a.due_ns < b.due_ns; });
  return messages.empty() ? Batches::fail(command.file + ": no samples")
                          : Batches::ok(std::move(messages));
}

/// When a recorded time comes again. Stamps are a stranger's: none overflows, and none makes us
/// wait for ever.
class Pace {
 public:
  Pace(std::int64_t first_ns, double scale) : first_ns_(first_ns), scale_(scale) {}

  SteadyTime due(std::int64_t recorded_ns) {
    // A recorded clock that steps back, or ahead by more than a day, makes no pause.
    constexpr double kLongestPauseNs = 24.0 * 3600.0 * 1e9;
    const double step = static_cast<double>(recorded_ns) -
                        static_cast<double>(std::exchange(last_ns_, recorded_ns));
    if (started_ && step > 0.0 && step <= kLongestPauseNs) elapsed_ns_ += step;
    started_ = true;
    return start_ + std::chrono::nanoseconds(to_ns(scale_ * elapsed_ns_));
  }

  /// The Unix time that stands for a recorded one.
  std::int64_t stamp_ns(std::int64_t recorded_ns) const {
    const double since = static_cast<double>(recorded_ns) - static_cast<double>(first_ns_);
    return to_ns(static_cast<double>(unix_start_ns_) + scale_ * since);
  }

 private:
  static std::int64_t to_ns(double value) {
    constexpr double kMost = 9.2e18;  // what an int64 can hold, and a little less
    return std::llround(std::clamp(value, -kMost, kMost));
  }

  SteadyTime start_ = now_steady();
  std::int64_t unix_start_ns_ = unix_time_ns();
  std::int64_t first_ns_;
  std::int64_t last_ns_ = 0;
  double scale_;
  double elapsed_ns_ = 0.0;
  bool started_ = false;
};

/// The exit code if no recognizer comes, or if a stop is asked for before.
std::optional<int> wait_for_recognizer(const ReplayCommand& command, int stop_fd,
                                       Progress& progress, client::ContactPublisher& publisher) {
  const std::string& endpoint = command.connection.endpoint;
  const auto give_up = now_steady() + std::chrono::duration<double>(command.wait_s);
  while (!publisher.wait_for_recognizer(std::chrono::milliseconds(50))) {
    if (!publisher.refusal().empty()) {
      return complain("the recognizer at " + endpoint + " " + publisher.refusal(), kFailed);
    }
    progress.tell([&] { return "waiting for a recognizer at " + endpoint; });
    if (stop_requested(stop_fd)) return kDone;
    if (now_steady() >= give_up) {
      return complain("no recognizer listens at " + endpoint, kFailed);
    }
  }
  return std::nullopt;
}

int run(const ReplayCommand& command) {
  const auto curve = curve_of(command.connection);
  if (!curve) {
    return complain(curve.error, kUsage);
  }
  std::optional<RecordedContacts> recording;
  std::vector<TimedMessage> batches;
  Messages next;
  if (is_recording(command.file)) {
    if (!command.for_points.empty()) {
      return complain(command.for_points.front() + ": for a file of points, and " + command.file +
                          " is a recording, played as it was recorded",
                      kUsage);
    }
    recording.emplace(command.file);
    if (const std::string error = recording->open(); !error.empty()) {
      return complain(error, kUsage);
    }
    next = [&](TimedMessage& message) { return recording->next(message); };
  } else {
    Result<std::vector<TimedMessage>> table = from_csv(command);
    if (!table) {
      return complain(table.error, kUsage);
    }
    batches = std::move(*table.value);
    next = [&, index = std::size_t{0}](TimedMessage& message) mutable {
      if (index == batches.size()) return false;
      message = std::move(batches[index++]);
      return true;
    };
  }
  const int stop_fd = take_stop_signals();
  client::ContactPublisherOptions options;
  options.endpoint = command.connection.endpoint;
  options.curve = *curve.value;
  options.all_readers_or_none = command.fast;
  client::ContactPublisher publisher(options);
  Progress progress;
  if (const auto end = wait_for_recognizer(command, stop_fd, progress, publisher)) return *end;
  // Objects of the recording become new ones: a second replay is another touch of the part.
  const auto first_object = static_cast<std::uint64_t>(unix_time_ns() / 1'000'000);
  std::map<std::uint64_t, std::uint64_t> objects;
  std::optional<Pace> pace;
  std::uint64_t messages = 0;
  std::uint64_t refused = 0;
  std::uint64_t samples = 0;
  bool is_stopped = false;
  for (TimedMessage message; next(message);) {
    if (!pace) pace.emplace(message.due_ns, command.fast ? 0.0 : 1.0 / command.speed);
    is_stopped = stop_requested_before(pace->due(message.due_ns), stop_fd);
    if (is_stopped) break;
    for (v1::ContactSample& sample : *message.batch.mutable_samples()) {
      if (sample.stamp_ns() == 0) continue;  // not known, and no replay makes it known
      sample.set_stamp_ns(command.fast ? unix_time_ns() : pace->stamp_ns(sample.stamp_ns()));
    }
    if (!command.keep_objects) {
      const auto number =
          objects.try_emplace(message.batch.object(), first_object + objects.size());
      message.batch.set_object(number.first->second);
    }
    // The numbers are the publisher's own. (Beyond the largest gap they would be no gap to a
    // recognizer but all that follows wrong.)
    if (message.lost_before < SequenceTracker::kLargestGap) {
      publisher.leave_out(message.probe, message.lost_before);
    }
    // At its own pace a recording does as its probes did, which wait for nobody. As fast as
    // possible it waits for room, but not for longer than for a recognizer to come.
    const bool is_taken = command.fast ? publisher.publish_when_room(
                                             message.probe, message.batch,
                                             std::chrono::duration<double>(command.wait_s),
                                             [&] { return is_stopped = stop_requested(stop_fd); })
                                       : publisher.publish(message.probe, message.batch);
    if (const std::string news = publisher.news_of_recognizer(); !news.empty()) {
      progress.end();
      complain("the recognizer at " + command.connection.endpoint + " " + news, kDone);
    }
    // What a stop keeps from waiting for room is like all that comes after it: not replayed.
    if (is_stopped) break;
    ++messages;
    samples += static_cast<std::uint64_t>(message.batch.samples_size());
    refused += is_taken ? 0 : 1;
    if (!is_taken && command.fast) break;
    progress.tell([&] {
      return command.file + ": " + std::to_string(messages) + " messages, " +
             std::to_string(samples) + " samples";
    });
  }
  progress.end();
  const bool has_gone = !is_stopped && refused == 0 && publisher.recognizer_has_gone();
  if (!is_stopped && !has_gone) publisher.finish_within();
  std::cerr << command.file << ": " << messages << " messages, " << samples << " samples";
  std::cerr << (refused > 0 ? ", " + counted(refused, "message") + " not taken\n" : "\n");
  const bool is_whole = !recording || recording->report();
  if (has_gone) {
    return complain("the recognizer at " + command.connection.endpoint +
                        " has gone: what was published since is lost",
                    kFailed);
  }
  if (const std::uint64_t lost = publisher.published_to_nobody(); lost > 0) {
    return complain(
        counted(lost, "message") + " lost: nobody listened at " + command.connection.endpoint,
        kFailed);
  }
  return refused == 0 && is_whole ? kDone : kFailed;
}

}  // namespace

void add_replay_command(CLI::App& app, int& exit_code) {
  auto replay = std::make_shared<ReplayCommand>();
  CLI::App* command = app.add_subcommand("replay",
                                         "Publish the contacts of a recording (palpate record "
                                         "--contacts) or of a CSV file as their probes\n"
                                         "would: at their own pace, stamped anew, as new objects.");
  command->add_option("FILE", replay->file, "Recording or CSV file")->required()->type_name("");
  add_connection_flags(*command, "--contacts", "The recognizer's contacts endpoint",
                       replay->connection);
  command->add_option("--speed", replay->speed, "Times as fast as recorded")
      ->check(positive_number())
      ->capture_default_str()
      ->type_name("FACTOR");
  command->add_flag("--fast", replay->fast, "As fast as possible");
  command->add_flag("--keep-objects", replay->keep_objects, "Keep the recorded object numbers");
  command
      ->add_option("--wait", replay->wait_s,
                   "Seconds to wait for a recognizer, or with --fast for room, before giving up")
      ->check(seconds_to_wait())
      ->capture_default_str()
      ->type_name("S");
  command
      ->add_option("--rate", replay->rate_hz, "CSV without stamps: samples a second of each probe")
      ->check(positive_number())
      ->capture_default_str()
      ->type_name("HZ");
  command->add_option("--batch", replay->batch_samples, "CSV: samples of a message")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str()
      ->type_name("N");
  command
      ->add_option("--sigma", replay->sigma_m,
                   "CSV: noise of samples that bring none; 0 = not known [m]")
      ->check(number_within(0.0, 1e3))
      ->capture_default_str()
      ->type_name("METRES");
  add_file_flags(*command, replay->flags);
  command->callback([replay, command, &exit_code] {
    for (const char* option : {"--rate", "--batch", "--sigma", "--unit", "--plane", "--touches",
                               "--strokes", "--tip-radius"}) {
      if (command->count(option) > 0) replay->for_points.emplace_back(option);
    }
    exit_code = run(*replay);
  });
}

}  // namespace palpate
