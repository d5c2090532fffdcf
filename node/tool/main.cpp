// palpate: the command-line tool. Each subcommand has a file <name>_command.cpp under commands/.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>

#include "core/curves/curve_class.h"
#include "node/client/connection.h"
#include "node/files/printable.h"
#include "node/files/written_file.h"
#include "node/process/quiet_protobuf.h"
#include "node/tool/commands/command.h"
#include "node/tool/commands/usage_error.h"

namespace palpate {

int complain(const std::string& why, int exit_code) {
  std::cerr << "palpate: " << printable_path(why) << "\n";
  return exit_code;
}

CLI::Validator curve_class_name() {
  const auto check = [](const std::string& text) -> std::string {
    const auto named = curve_class_from_name(text);
    if (named && *named != CurveClass::Unclassified) return "";
    std::string known;
    for (const CurveClass one : kCurveClasses) {
      known += (known.empty() ? "" : ", ") + std::string(name_of(one));
    }
    return "\"" + text + "\" is no curve class: " + known;
  };
  return CLI::Validator(check, "");
}

CLI::Validator svg_file() {
  const auto check = [](const std::string& text) -> std::string {
    if (text == "-") return "\"-\" names no file: pictures do not go to standard output";
    const std::string ending = std::filesystem::path(text).extension();
    const bool good = ending.empty() || CLI::detail::to_lower(ending) == ".svg";
    return good ? "" : "\"" + text + "\" does not end in .svg: pictures are written as SVG only";
  };
  return CLI::Validator(check, "");
}

KeyFlags add_connection_flags(CLI::App& command, const char* flag, const char* help,
                              Connection& connection) {
  command.add_option(flag, connection.endpoint, help)->capture_default_str()->type_name("ENDPOINT");
  return add_key_flags(command, connection.own_key, "CURVE: our secret key file (palpate keygen)",
                       connection.recognizer_key, "CURVE: the recognizer's public key file");
}

Result<std::optional<CurveClient>> curve_of(const Connection& connection) {
  using Curve = Result<std::optional<CurveClient>>;
  if (connection.own_key.empty()) {
    return Curve::ok(std::nullopt);
  }
  Result<CurveClient> client =
      client::read_curve_client(connection.own_key, connection.recognizer_key);
  return client ? Curve::ok(std::move(client.value)) : Curve::fail(client.error);
}

}  // namespace palpate

namespace {

int run(int argc, char** argv) {
  CLI::App app(
      "Recognises and locates curved parts by touch: offline from files, and beside a running "
      "palpate-node.\n"
      "Exit codes: 0 done, 1 failed at run time, 2 usage or bad input.",
      "palpate");
  app.set_version_flag("--version", PALPATE_VERSION);
  app.require_subcommand(1);
  app.option_defaults()->disable_flag_override();  // --touches=maybe is a mistake
  int exit_code = palpate::kDone;
  palpate::add_fit_command(app, exit_code);
  palpate::add_calibrate_command(app, exit_code);
  palpate::add_estimate_command(app, exit_code);
  palpate::add_watch_command(app, exit_code);
  palpate::add_view_command(app, exit_code);
  palpate::add_list_command(app, exit_code);
  palpate::add_hz_command(app, exit_code);
  palpate::add_record_command(app, exit_code);
  palpate::add_replay_command(app, exit_code);
  palpate::add_check_command(app, exit_code);
  palpate::add_keygen_command(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool is_help = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success);
    if (!is_help) {
      return palpate::complain(palpate::usage_error(app, error), palpate::kUsage);
    }
    app.exit(error);  // prints it
    return palpate::kDone;
  } catch (const std::exception& error) {
    return palpate::complain(error.what(), palpate::kFailed);
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  palpate::silence_protobuf();
  const int exit_code = run(argc, argv);
  // Check that all output has been written: a full disk shows only now.
  const std::string why = palpate::flush_standard_output();
  if (!why.empty() && exit_code == palpate::kDone) return palpate::complain(why, palpate::kFailed);
  return exit_code;
}
