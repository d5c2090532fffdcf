// palpate list: the topics that a recognizer publishes on.
#include <cstdio>
#include <memory>

#include "node/files/printable.h"
#include "node/process/stop_signals.h"
#include "node/tool/commands/live/topic_counts.h"

namespace palpate {
namespace {

struct ListCommand {
  Connection connection{std::string(kDefaultResultsEndpoint), "", ""};
  double seconds = 2.0;
};

int run(const ListCommand& command) {
  const int stop_fd = take_stop_signals();
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(command.seconds);
  const auto counts = count_topics(command.connection, [&](const auto&) {
    return stop_requested(stop_fd) || std::chrono::steady_clock::now() >= end;
  });
  if (!counts) {
    return complain(counts.error, kUsage);
  }
  if (!counts.value->refusal.empty()) {
    return complain(counts.value->refusal, kFailed);
  }
  for (const auto& [topic, count] : counts.value->by_topic) {
    std::printf("%s\t%llu messages\n", printable(topic).c_str(),
                static_cast<unsigned long long>(count.messages));
  }
  return counts.value->by_topic.empty()
             ? complain("nothing heard on " + command.connection.endpoint, kFailed)
             : kDone;
}

}  // namespace

void add_list_command(CLI::App& app, int& exit_code) {
  auto list = std::make_shared<ListCommand>();
  CLI::App* command =
      app.add_subcommand("list", "List the topics on which the recognizer publishes.");
  add_connection_flags(*command, "--results", "The recognizer's results endpoint",
                       list->connection);
  command->add_option("--seconds", list->seconds, "How long to listen [s]")
      ->check(positive_number())
      ->capture_default_str()
      ->type_name("S");
  command->callback([list, &exit_code] { exit_code = run(*list); });
}

}  // namespace palpate
