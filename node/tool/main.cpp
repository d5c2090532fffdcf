// palpate: the tool beside the recognizer node. Each subcommand has a file <name>_command.cpp.
#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "node/tool/command.h"

int palpate::complain(const std::string& why, int exit_code) {
  std::cerr << "palpate: " << why << "\n";
  return exit_code;
}

int main(int argc, char** argv) {
  CLI::App app(
      "Recognises and locates curved parts by touch: offline from files, and beside a running "
      "palpate-node.\n"
      "Exit codes: 0 done, 1 failed at run time, 2 usage or bad input.",
      "palpate");
  app.set_version_flag("--version", PALPATE_VERSION);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  int exit_code = palpate::kDone;
  palpate::add_fit_command(app, exit_code);
  palpate::add_estimate_command(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? palpate::kDone : palpate::kUsage;
  } catch (const std::exception& error) {
    return palpate::complain(error.what(), palpate::kFailed);
  }
  return exit_code;
}
