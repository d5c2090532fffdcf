// The subcommands of the palpate tool, and what they share.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "node/process/number_checks.h"
#include "node/wire/key_flags.h"
#include "node/wire/socket.h"

namespace palpate {

/// Exit codes of all subcommands.
enum ExitCode { kDone = 0, kFailed = 1, kUsage = 2 };

/// Each adds one subcommand; when it is chosen, `exit_code` receives how it ended.
void add_calibrate_command(CLI::App& app, int& exit_code);
void add_check_command(CLI::App& app, int& exit_code);
void add_estimate_command(CLI::App& app, int& exit_code);
void add_fit_command(CLI::App& app, int& exit_code);
void add_hz_command(CLI::App& app, int& exit_code);
void add_keygen_command(CLI::App& app, int& exit_code);
void add_list_command(CLI::App& app, int& exit_code);
void add_record_command(CLI::App& app, int& exit_code);
void add_replay_command(CLI::App& app, int& exit_code);
void add_view_command(CLI::App& app, int& exit_code);
void add_watch_command(CLI::App& app, int& exit_code);

/// For options: a class that a curve can be of; the error lists them.
CLI::Validator curve_class_name();

/// For options: a file for a picture. A name without an ending, such as /dev/stdout, is good too.
CLI::Validator svg_file();

/// Says on standard error what is wrong.
int complain(const std::string& why, int exit_code);

/// How a command that talks to a recognizer reaches it.
struct Connection {
  std::string endpoint;
  std::string own_key;
  std::string recognizer_key;
};

/// `flag`: "--results" or "--contacts"; connection.endpoint holds its default.
KeyFlags add_connection_flags(CLI::App& command, const char* flag, const char* help,
                              Connection& connection);

/// The keys that it names; nullopt within where CURVE is not asked for.
Result<std::optional<CurveClient>> curve_of(const Connection& connection);

}  // namespace palpate
