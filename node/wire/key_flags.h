// --curve-secret-key and --curve-server-key, alike in every program that connects to a recognizer.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace palpate {

/// For options: the name of a key file. An empty one, as of a variable that is not set, would ask
/// for no CURVE: what is meant to be secret would go out in the clear.
inline CLI::Validator key_file_name() {
  const auto check = [](const std::string& text) -> std::string {
    return text.empty() ? "the name of a key file is empty" : "";
  };
  return CLI::Validator(check, "");
}

struct KeyFlags {
  CLI::Option* own;
  CLI::Option* recognizer;
};

/// Each key needs the other: with one alone nothing would be secret.
inline KeyFlags add_key_flags(CLI::App& command, std::string& own_key, const char* own_help,
                              std::string& recognizer_key, const char* recognizer_help) {
  const KeyFlags flags{command.add_option("--curve-secret-key", own_key, own_help),
                       command.add_option("--curve-server-key", recognizer_key, recognizer_help)};
  for (CLI::Option* option : {flags.own, flags.recognizer}) {
    option->check(key_file_name())->type_name("FILE");
  }
  flags.own->needs(flags.recognizer);
  flags.recognizer->needs(flags.own);
  return flags;
}

}  // namespace palpate
