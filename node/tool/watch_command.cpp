// palpate watch: what the recognizer says, live.
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <string>

#include "node/client/result_subscriber.h"
#include "node/clock.h"
#include "node/stop_signals.h"
#include "node/tool/command.h"
#include "node/tool/message_json.h"
#include "node/tool/quantity.h"
#include "node/tool/recognition_text.h"

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
};

/// Since the newest sample was taken, by the two clocks.
std::string latency_text(const v1::Recognition& answer) {
  if (answer.newest_sample_stamp_ns() == 0) {
    return "";
  }
  const double ms = 1e-6 * static_cast<double>(unix_time_ns() - answer.newest_sample_stamp_ns());
  char text[48];
  std::snprintf(text, sizeof text, " [%.2f ms after the touch]", ms);
  return text;
}

class Watch {
 public:
  Watch(const WatchCommand& command, int stop_fd, const client::ResultSubscriberOptions& options)
      : command_(command), stop_fd_(stop_fd), subscriber_(options) {}

  int run() {
    const auto step = std::chrono::milliseconds(50);
    auto heard = Clock::now();
    while (!stop_requested(stop_fd_)) {
      const client::ReceivedResult result = subscriber_.receive(step);
      const auto now = Clock::now();
      // Where recognitions are waited for, the node's being alive is none.
      if (command_.count > 0 ? result.recognition != nullptr : static_cast<bool>(result)) {
        heard = now;
      } else if (command_.timeout_s > 0.0 &&
                 now - heard > std::chrono::duration<double>(command_.timeout_s)) {
        print_held(now, true);
        return complain("nothing heard for " + number(command_.timeout_s) + " s on " +
                            command_.connection.endpoint,
                        kFailed);
      }
      if (result.recognition != nullptr) {
        ++recognitions_;
        take(*result.recognition);
      }
      if (result.status != nullptr) {
        take(*result.status);
      }
      const bool last = command_.count > 0 && recognitions_ >= command_.count;
      print_held(now, last);
      if (last || !std::cout) {
        break;
      }
    }
    return std::cout ? kDone : complain("standard output: cannot be written", kFailed);
  }

 private:
  struct Shown {
    v1::Recognition held;
    std::string latency;
    bool is_held = false;
    Clock::time_point at;
  };

  void take(const v1::Recognition& answer) {
    if (command_.format == "json") {
      std::cout << json_line(answer) << std::flush;
      return;
    }
    Shown& shown = groups_[answer.group()];
    shown.held = answer;
    shown.latency = latency_text(answer);
    shown.is_held = true;
  }

  /// A person reads a few lines a second: the newest answer of each group, no oftener than asked.
  void print_held(Clock::time_point now, bool all) {
    for (auto& [group, shown] : groups_) {
      if (shown.is_held &&
          (all || now - shown.at >= std::chrono::duration<double>(command_.interval_s))) {
        clear_table();
        std::cout << group << " object " << shown.held.object() << ": " << summary_text(shown.held)
                  << ", " << shown.held.sample_count() << " samples" << shown.latency
                  << std::endl;
        shown.at = now;
        shown.is_held = false;
      }
    }
  }

  void take(const v1::NodeStatus& status) {
    if (command_.format == "json") {
      std::cout << json_line(status) << std::flush;
      return;
    }
    const bool table = is_terminal_ && !status.probes().empty();
    for (const v1::ProbeStatus& probe : status.probes()) {
      Probe& known = probes_[probe.probe()];
      const bool news = !known.seen || known.alive != probe.alive() || known.gaps != probe.gaps() ||
                        known.rejected != probe.rejected() || known.restarts != probe.restarts();
      if (news && !table) {
        std::cout << probe_line(probe) << std::endl;
      }
      known = {true, probe.alive(), probe.gaps(), probe.rejected(), probe.restarts()};
    }
    if (table) {
      clear_table();
      for (const v1::ProbeStatus& probe : status.probes()) {
        std::cout << probe_line(probe).substr(0, terminal_columns()) << "\n";
      }
      std::cout << std::flush;
      table_lines_ = status.probes_size();
    }
  }

  static std::string probe_line(const v1::ProbeStatus& probe) {
    char text[256];
    std::snprintf(text, sizeof text,
                  "probe %s: %s, %.0f samples/s, heard %.2f s ago, %llu gaps (%llu lost), %llu rejected, "
                  "%llu restarts",
                  probe.probe().c_str(), probe.alive() ? "alive" : "SILENT", probe.sample_rate_hz(),
                  std::max(probe.age_s(), 0.0), static_cast<unsigned long long>(probe.gaps()),
                  static_cast<unsigned long long>(probe.missing()),
                  static_cast<unsigned long long>(probe.rejected()),
                  static_cast<unsigned long long>(probe.restarts()));
    return text;
  }

  /// A line that wraps could not be taken away again.
  static std::size_t terminal_columns() {
    winsize size{};
    constexpr std::size_t kUsual = 80;
    return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsual;
  }

  /// On a terminal the probes' lines stay below the answers: they are taken away before a line is added.
  void clear_table() {
    for (; table_lines_ > 0; --table_lines_) {
      std::cout << "\033[A\033[2K";
    }
  }

  struct Probe {
    bool seen = false;
    bool alive = false;
    std::uint64_t gaps = 0;
    std::uint64_t rejected = 0;
    std::uint64_t restarts = 0;
  };

  const WatchCommand& command_;
  int stop_fd_;
  client::ResultSubscriber subscriber_;
  std::uint64_t recognitions_ = 0;
  std::map<std::string, Shown> groups_;
  std::map<std::string, Probe> probes_;
  const bool is_terminal_ = isatty(STDOUT_FILENO) != 0;
  int table_lines_ = 0;
};

int run(const WatchCommand& command) {
  const auto curve = curve_of(command.connection);
  if (!curve) {
    return complain(curve.error, kUsage);
  }
  client::ResultSubscriberOptions options;
  options.endpoint = command.connection.endpoint;
  options.groups = command.groups;
  options.status = true;
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
      "Show what the recognizer says: class, parameters and pose with their standard deviations, time\n"
      "since the touch, and the probes: on a terminal a line each below the answers, renewed with every\n"
      "NodeStatus; elsewhere a line where one falls silent, comes back or loses messages.");
  command->add_option("GROUP", watch->groups, "Groups to watch; none = all")->type_name("");
  add_connection_flags(*command, "--results", "The recognizer's results endpoint",
                       watch->connection);
  command
      ->add_option("--format", watch->format,
                   "text, or json: every Recognition and NodeStatus of the wire contract, one a line")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str()
      ->type_name("FORMAT");
  command->add_option("--interval", watch->interval_s, "Text: least time between a group's lines [s]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->type_name("S");
  command->add_option("--count", watch->count, "End after so many recognitions; 0 = never")
      ->capture_default_str()
      ->type_name("N");
  command
      ->add_option("--timeout", watch->timeout_s,
                   "Fail where nothing (with --count: no recognition) is heard for so long; 0 = wait for ever [s]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->type_name("S");
  command->callback([watch, &exit_code] { exit_code = run(*watch); });
}

}  // namespace palpate
