#include "node/tool/commands/usage_error.h"

#include <algorithm>
#include <vector>

#include "node/files/nearest_word.h"
#include "node/files/printable.h"

namespace palpate {
namespace {

/// ", did you mean NAME?", or "" if none of them is like it.
std::string did_you_mean(const std::string& wrong, const std::vector<std::string>& names) {
  const std::string nearest = nearest_word(wrong, names);
  return nearest.empty() ? "" : ", did you mean " + nearest + "?";
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

}  // namespace

std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  const CLI::App& command = chosen.empty() ? app : *chosen.front();
  const std::string whose = chosen.empty() ? "" : " of " + command.get_name();
  const std::string help = "palpate " + (chosen.empty() ? "" : command.get_name() + " ") + "--help";
  // CLI11 asks for a command where an unknown one was given, so what it names is no matter.
  const std::vector<std::string> unknown = command.remaining();
  const auto option = std::find_if(unknown.begin(), unknown.end(), [](const std::string& word) {
    return word.size() > 1 && word.front() == '-';
  });
  if (option != unknown.end()) {
    const std::string name = option->substr(0, option->find('='));
    const std::string nearest = did_you_mean(name, option_names(command));
    return "there is no option " + printable(name) + whose +
           (nearest.empty() ? "; " : nearest + " ") + help + " lists them";
  }
  if (chosen.empty() && !unknown.empty()) {
    const std::string nearest = did_you_mean(unknown.front(), command_names(app));
    return "there is no command " + printable(unknown.front()) +
           (nearest.empty() ? "; " : nearest + " ") + help + " lists them";
  }
  std::string what = error.what();
  std::replace(what.begin(), what.end(), '\n', ' ');
  return what + (what.ends_with('.') ? " " : "; ") + help + " says more";
}

}  // namespace palpate
