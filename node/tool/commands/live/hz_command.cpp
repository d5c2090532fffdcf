// palpate hz: how often the recognizer publishes, topic by topic.
#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <string>

#include "node/files/printable.h"
#include "node/process/stop_signals.h"
#include "node/tool/commands/live/topic_counts.h"

namespace palpate {
namespace {

struct HzCommand {
  Connection connection{std::string(kDefaultResultsEndpoint), "", ""};
  double seconds = 0.0;
};

void print(const std::map<std::string, TopicCount>& counts) {
  const auto now = std::chrono::steady_clock::now();
  for (const auto& [topic, count] : counts) {
    std::printf("%-40s %8.1f Hz  intervals %.1f to %.1f ms  %llu messages",
                printable(topic).c_str(), count.rate_hz(now), 1e3 * count.shortest_s,
                1e3 * count.longest_s, static_cast<unsigned long long>(count.messages));
    if (count.repeats > 0) {
      std::printf(", %llu repeats", static_cast<unsigned long long>(count.repeats));
    }
    if (const double silence_s = count.silence_s(now); silence_s > 0.0) {
      std::printf(", no message for %.0f s", silence_s);
    }
    std::printf("\n");
  }
  std::fflush(stdout);
}

int run(const HzCommand& command) {
  using Clock = std::chrono::steady_clock;
  const int stop_fd = take_stop_signals();
  const auto start = Clock::now();
  auto next = start + std::chrono::seconds(1);
  const auto counts = count_topics(command.connection, [&](const auto& so_far) {
    const auto now = Clock::now();
    const bool end =
        stop_requested(stop_fd) || std::ferror(stdout) != 0 ||
        (command.seconds > 0.0 && now - start >= std::chrono::duration<double>(command.seconds));
    if (!end && command.seconds == 0.0 && now >= next) {
      print(so_far);
      std::printf("\n");
      next = now + std::chrono::seconds(1);
    }
    return end;
  });
  if (!counts) {
    return complain(counts.error, kUsage);
  }
  if (!counts.value->refusal.empty()) {
    return complain(counts.value->refusal, kFailed);
  }
  print(counts.value->by_topic);
  return counts.value->by_topic.empty()
             ? complain("nothing heard on " + command.connection.endpoint, kFailed)
             : kDone;
}

}  // namespace

void add_hz_command(CLI::App& app, int& exit_code) {
  auto hz = std::make_shared<HzCommand>();
  CLI::App* command = app.add_subcommand(
      "hz", "Show how often the recognizer publishes on each topic, once a second.");
  add_connection_flags(*command, "--results", "The recognizer's results endpoint", hz->connection);
  command
      ->add_option("--seconds", hz->seconds, "Listen so long, then show it once; 0 = for ever [s]")
      ->check(seconds_to_wait())
      ->capture_default_str()
      ->type_name("S");
  command->callback([hz, &exit_code] { exit_code = run(*hz); });
}

}  // namespace palpate
