// A subcommand of the palpate tool.
#pragma once

#include <CLI/CLI.hpp>

namespace palpate {

/// Exit codes of all subcommands.
enum ExitCode { kDone = 0, kFailed = 1, kUsage = 2 };

/// Each adds one subcommand; when it is chosen, `exit_code` receives how it ended.
void add_fit_command(CLI::App& app, int& exit_code);
void add_estimate_command(CLI::App& app, int& exit_code);

/// Says on standard error what is wrong.
int complain(const std::string& why, int exit_code);

}  // namespace palpate
