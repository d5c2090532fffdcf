// palpate watch: what the recognizer says, live.
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "node/client/result_subscriber.h"
#include "node/files/printable.h"
#include "node/files/quantity.h"
#include "node/files/written_file.h"
#include "node/process/clock.h"
#include "node/process/stop_signals.h"
#include "node/tool/commands/command.h"
#include "node/tool/drawing/terminal_plot.h"
#include "node/tool/text/message_json.h"
#include "node/tool/text/recognition_text.h"
#include "node/tool/text/watch_table.h"
#include "node/tool/view/live_state.h"

namespace palpate {
namespace {

using Clock = std::chrono::steady_clock;

struct WatchCommand {
  Connection connection{std::string(kDefaultResultsEndpoint), "", ""};
  std::vector<std::string> groups;
  std::string format = "text";
  std::uint64_t count = 0;
  double timeout_s = 0.0;
  double interval_s = 0.2;
  bool plot = false;
};

/// Since the newest sample was taken, by the two clocks. 0 = not known. [ms]
double latency_ms_of(const v1::Recognition& answer) {
  if (answer.newest_sample_stamp_ns() == 0) return 0.0;
  // As doubles: a sender may claim any stamp.
  return 1e-6 * (static_cast<double>(unix_time_ns()) -
                 static_cast<double>(answer.newest_sample_stamp_ns()));
}

struct TerminalSize {
  std::size_t columns = 80;
  std::size_t rows = 24;
};

/// nullopt where standard output is no terminal.
std::optional<TerminalSize> terminal_size() {
  if (isatty(STDOUT_FILENO) == 0) return std::nullopt;
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return TerminalSize();
  return TerminalSize{size.ws_col, std::max<std::size_t>(size.ws_row, 4)};
}

/// Where what the recognizer says goes.
class WatchOutput {
 public:
  virtual ~WatchOutput() = default;
  virtual void take(const v1::Recognition& answer) = 0;
  virtual void take(const v1::NodeStatus& status) = 0;
  /// Comes where contacts are subscribed to.
  virtual void take(const v1::ContactBatch&) {}
  /// Called at least every 50 ms. `silent_s`: since anything was heard; `last`: nothing comes
  /// after.
  virtual void refresh(Clock::time_point now, double silent_s, bool last) = 0;
};

/// Every message of the wire contract, one a line.
class JsonLines : public WatchOutput {
 public:
  void take(const v1::Recognition& answer) override {
    std::cout << json_line(answer) << std::flush;
  }
  void take(const v1::NodeStatus& status) override { std::cout << json_line(status) << std::flush; }
  void refresh(Clock::time_point, double, bool) override {}
};

/// For files and pipes: a line where something is new.
class TextLines : public WatchOutput {
 public:
  explicit TextLines(double interval_s) : interval_(interval_s) {}

  void take(const v1::Recognition& answer) override {
    was_heard_ = true;
    Shown& shown = groups_[answer.group()];
    shown.held = answer;
    shown.latency_ms = latency_ms_of(answer);
    shown.is_held = true;
  }

  void take(const v1::NodeStatus& status) override {
    was_heard_ = true;
    for (const v1::ProbeStatus& probe : status.probes()) {
      Probe& known = probes_[probe.probe()];
      const bool news = !known.seen || known.alive != probe.alive() || known.gaps != probe.gaps() ||
                        known.rejected != probe.rejected() || known.restarts != probe.restarts();
      if (news) std::cout << probe_line(probe) << std::endl;
      known = {true, probe.alive(), probe.gaps(), probe.rejected(), probe.restarts()};
    }
    std::uint64_t& told = superseded_[status.header().source()];
    if (std::exchange(told, status.objects_superseded()) < status.objects_superseded()) {
      std::cout << "recognizer " << printable(status.header().source()) << ": "
                << superseded_text(status) << std::endl;
    }
  }

  /// A person reads a few lines a second: the newest answer of each group, no oftener than asked.
  void refresh(Clock::time_point now, double silent_s, bool last) override {
    for (auto& [group, shown] : groups_) {
      if (!shown.is_held || (!last && now - shown.at < interval_)) continue;
      std::cout << printable(group) << " object " << shown.held.object() << ": "
                << summary_text(shown.held) << ", " << shown.held.sample_count() << " samples";
      if (shown.latency_ms != 0.0) {
        std::printf(" [%.2f ms after the touch]", shown.latency_ms);
        std::fflush(stdout);
      }
      if (!shown.held.invariants().empty()) {
        std::cout << "; invariants: " << invariants_text(shown.held);
      }
      std::cout << std::endl;
      shown.at = now;
      shown.is_held = false;
    }
    const bool is_silent = silent_s > kRecognizerSilence.count();
    if (is_silent && !was_silent_) {
      std::cout << (was_heard_ ? silence_text(silent_s) : "no recognizer heard yet") << std::endl;
    }
    if (!is_silent && was_silent_) std::cout << "recognizer heard again" << std::endl;
    was_silent_ = is_silent;
  }

 private:
  struct Shown {
    v1::Recognition held;
    double latency_ms = 0.0;
    bool is_held = false;
    Clock::time_point at;
  };

  struct Probe {
    bool seen = false;
    bool alive = false;
    std::uint64_t gaps = 0;
    std::uint64_t rejected = 0;
    std::uint64_t restarts = 0;
  };

  static std::string probe_line(const v1::ProbeStatus& probe) {
    char text[256];
    std::snprintf(
        text, sizeof text,
        "probe %s: %s, %.0f samples/s, heard %.2f s ago, %llu gaps (%llu lost), %llu rejected, "
        "%llu restarts",
        printable(probe.probe()).c_str(), probe.alive() ? "alive" : "SILENT",
        probe.sample_rate_hz(), probe.age_s(), static_cast<unsigned long long>(probe.gaps()),
        static_cast<unsigned long long>(probe.missing()),
        static_cast<unsigned long long>(probe.rejected()),
        static_cast<unsigned long long>(probe.restarts()));
    return text;
  }

  std::chrono::duration<double> interval_;
  std::map<std::string, Shown> groups_;
  std::map<std::string, Probe> probes_;
  std::map<std::string, std::uint64_t> superseded_;  // objects, by node
  bool was_silent_ = false;
  bool was_heard_ = false;
};

/// For a terminal: one table, drawn again in its place; with a picture of the group touched last
/// under it, where that is asked for.
class Table : public WatchOutput {
 public:
  explicit Table(const WatchCommand& command)
      : interval_(command.interval_s), plot_(command.plot), wanted_(command.groups) {}

  void take(const v1::Recognition& answer) override {
    state_.groups[answer.group()] = {answer, latency_ms_of(answer)};
    if (plot_) touched_.take(answer, Clock::now(), unix_time_ns());
  }

  void take(const v1::ContactBatch& batch) override {
    const std::string& group = batch.group().empty() ? batch.header().source() : batch.group();
    const bool is_wanted =
        wanted_.empty() || std::find(wanted_.begin(), wanted_.end(), group) != wanted_.end();
    if (is_wanted) touched_.take(batch, Clock::now());
  }

  void take(const v1::NodeStatus& status) override {
    state_.status = status;
    state_.has_status = true;
  }

  void refresh(Clock::time_point now, double silent_s, bool last) override {
    if (!last && now - drawn_ < interval_) return;
    drawn_ = now;
    state_.silent_s = silent_s;
    const TerminalSize size = terminal_size().value_or(TerminalSize());
    // The last row is the cursor's. The picture gets what the table leaves, at least half.
    const std::size_t rows = size.rows - 1;
    auto lines = watch_table(state_, size.columns, plot_ ? rows - rows / 2 : rows);
    for (std::string& line : picture(now, size.columns, rows - lines.size())) {
      lines.push_back(std::move(line));
    }
    std::string screen;
    if (lines_ > 0) screen += "\033[" + std::to_string(lines_) + "A";
    for (const std::string& line : lines) screen += "\033[2K" + line + "\n";
    std::cout << screen << "\033[J" << std::flush;
    lines_ = lines.size();
  }

 private:
  std::vector<std::string> picture(Clock::time_point now, std::size_t columns, std::size_t rows) {
    if (!plot_) return {};
    shown_ = touched_.followed_group(shown_, now);
    const LiveGroup* const group = touched_.find(shown_);
    if (group == nullptr) return {};
    return terminal_plot(group->touched, group->answer, columns, rows);
  }

  std::chrono::duration<double> interval_;
  bool plot_;
  const std::vector<std::string>& wanted_;
  LiveState touched_;
  std::string shown_;  // group in the picture
  WatchedState state_;
  Clock::time_point drawn_;
  std::size_t lines_ = 0;
};

std::unique_ptr<WatchOutput> make_output(const WatchCommand& command) {
  if (command.format == "json") return std::make_unique<JsonLines>();
  if (terminal_size()) return std::make_unique<Table>(command);
  return std::make_unique<TextLines>(command.interval_s);
}

class Watch {
 public:
  Watch(const WatchCommand& command, int stop_fd, const client::ResultSubscriberOptions& options)
      : command_(command), stop_fd_(stop_fd), subscriber_(options), output_(make_output(command)) {}

  int run() {
    const auto step = std::chrono::milliseconds(50);
    auto heard = Clock::now();
    auto alive = heard;
    std::uint64_t recognitions = 0;
    while (!stop_requested(stop_fd_)) {
      const client::ReceivedResult result = subscriber_.receive(step);
      const auto now = Clock::now();
      if (result) alive = now;
      if (!subscriber_.refusal().empty()) {
        return complain(
            "the recognizer at " + command_.connection.endpoint + " " + subscriber_.refusal(),
            kFailed);
      }
      const double silent_s = std::chrono::duration<double>(now - alive).count();
      // Where recognitions are waited for, the node's being alive is none.
      if (command_.count > 0 ? result.recognition != nullptr : static_cast<bool>(result)) {
        heard = now;
      } else if (command_.timeout_s > 0.0 &&
                 now - heard > std::chrono::duration<double>(command_.timeout_s)) {
        output_->refresh(now, silent_s, true);
        std::string groups;
        for (const std::string& group : command_.groups) {
          groups += (groups.empty() ? " of group " : ", ") + printable(group);
        }
        const bool is_alive = silent_s <= command_.timeout_s;
        return complain(
            (is_alive ? "no recognition" + groups + " heard for " : "nothing heard for ") +
                number(command_.timeout_s) + " s on " + command_.connection.endpoint,
            kFailed);
      }
      if (result.recognition != nullptr) {
        ++recognitions;
        output_->take(*result.recognition);
      }
      if (result.status != nullptr) output_->take(*result.status);
      if (result.contact != nullptr) output_->take(*result.contact);
      const bool last = command_.count > 0 && recognitions >= command_.count;
      output_->refresh(now, silent_s, last);
      if (last || !std::cout) break;
    }
    const std::string why = flush_standard_output();
    return why.empty() ? kDone : complain(why, kFailed);
  }

 private:
  const WatchCommand& command_;
  int stop_fd_;
  client::ResultSubscriber subscriber_;
  std::unique_ptr<WatchOutput> output_;
};

int run(const WatchCommand& command) {
  const auto curve = curve_of(command.connection);
  if (!curve) {
    return complain(curve.error, kUsage);
  }
  if (command.plot && (command.format == "json" || !terminal_size())) {
    return complain("--plot draws on a terminal: this output is none (palpate view shows more)",
                    kUsage);
  }
  client::ResultSubscriberOptions options;
  options.endpoint = command.connection.endpoint;
  options.groups = command.groups;
  options.status = true;
  options.contacts = command.plot;
  options.curve = *curve.value;
  const int stop_fd = take_stop_signals();
  try {
    return Watch(command, stop_fd, options).run();
  } catch (const std::invalid_argument& error) {
    return complain(error.what(), kUsage);
  }
}

}  // namespace

void add_watch_command(CLI::App& app, int& exit_code) {
  auto watch = std::make_shared<WatchCommand>();
  CLI::App* command = app.add_subcommand(
      "watch",
      "Show what the recognizer says: class, parameters and pose with their standard deviations, "
      "the\n"
      "recognition tree's invariants, time since the touch, and the probes: on a terminal one "
      "table that is drawn anew; elsewhere a "
      "line where\n"
      "there is an answer, and where a probe falls silent, comes back or loses messages.");
  command->add_option("GROUP", watch->groups, "Groups to watch; none = all")->type_name("");
  add_connection_flags(*command, "--results", "The recognizer's results endpoint",
                       watch->connection);
  command
      ->add_option(
          "--format", watch->format,
          "text, or json: every Recognition and NodeStatus of the wire contract, one a line")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str()
      ->type_name("FORMAT");
  command
      ->add_option("--interval", watch->interval_s,
                   "Text: least time between a group's lines, and between two tables [s]")
      ->check(seconds_to_wait())
      ->capture_default_str()
      ->type_name("S");
  command->add_flag("--plot", watch->plot,
                    "On a terminal, under the table: a small picture of what was touched last, in "
                    "braille dots");
  command->add_option("--count", watch->count, "End after so many recognitions; 0 = never")
      ->check(counting_number())
      ->capture_default_str()
      ->type_name("N");
  command
      ->add_option("--timeout", watch->timeout_s,
                   "Fail where nothing (with --count: no recognition) is heard for so long; 0 = "
                   "wait for ever [s]")
      ->check(seconds_to_wait())
      ->capture_default_str()
      ->type_name("S");
  command->callback([watch, &exit_code] { exit_code = run(*watch); });
}

}  // namespace palpate
