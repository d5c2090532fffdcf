// palpate-node: the recognizer node. Exit codes: 0 stopped by a signal, 1 failed at run time (for
// example an endpoint is in use), 2 usage, 6 configuration.
#include <spdlog/spdlog.h>

#include <google/protobuf/text_format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "node/config.h"
#include "node/environment.h"
#include "node/files/printable.h"
#include "node/files/probe_files.h"
#include "node/files/written_file.h"
#include "node/node.h"
#include "node/process/log_sink.h"
#include "node/process/quiet_protobuf.h"
#include "node/process/reload_signal.h"
#include "node/process/stop_signals.h"

namespace {

using palpate::NodeOptions;
using palpate::Result;
using palpate::v1::NodeConfig;

enum ExitCode { kStopped = 0, kFailed = 1, kUsage = 2, kBadConfiguration = 6 };

struct CommandLine {
  NodeConfig flags;
  std::string config_file;
  bool check_config = false;
  bool print_config = false;
};

std::string default_text(const NodeConfig& defaults, const std::string& name) {
  const auto* field = NodeConfig::descriptor()->FindFieldByName(name);
  const int index = field->is_repeated() ? 0 : -1;
  if (field->is_repeated() && NodeConfig::GetReflection()->FieldSize(defaults, field) == 0)
    return "";
  std::string text;
  google::protobuf::TextFormat::PrintFieldValueToString(defaults, field, index, &text);
  return text;
}

// Adds one flag for each option of the table.
void add_flags(CLI::App& app, NodeConfig& flags) {
  NodeOptions options;
  const NodeConfig defaults = palpate::to_config(options);
  palpate::for_each_option(options, [&](const palpate::OptionInfo& info, const auto& field) {
    using Field = std::decay_t<decltype(field)>;
    const std::string name = info.name;
    const auto set = [&flags, name](const std::string& text) {
      if (const std::string why = palpate::set_option(flags, name, text); !why.empty()) {
        throw CLI::ValidationError(palpate::flag_of(name), why);
      }
    };
    if constexpr (palpate::is_switch<Field>) {
      app.add_flag_function(
          palpate::switch_flags_of(info),
          [set](std::int64_t count) { set(count > 0 ? "true" : "false"); }, info.help);
    } else if constexpr (std::is_same_v<Field, std::vector<std::string>>) {
      app.add_option_function<std::vector<std::string>>(
             palpate::flags_of(info),
             [set](const std::vector<std::string>& texts) {
               for (const std::string& text : texts) set(text);
             },
             info.help)
          ->allow_extra_args(false)
          ->type_name("")
          ->default_str(default_text(defaults, name));
    } else {
      app.add_option_function<std::string>(palpate::flags_of(info), set, info.help)
          ->type_name("")
          ->default_str(default_text(defaults, name));
    }
  });
}

Result<NodeOptions> all_options(const CommandLine& command_line) {
  using Options = Result<NodeOptions>;
  NodeConfig config;
  const std::string config_file = command_line.config_file.empty()
                                      ? palpate::config_file_from_environment()
                                      : command_line.config_file;
  if (!config_file.empty()) {
    const Result<NodeConfig> file = palpate::read_config_file(config_file);
    if (!file) return Options::fail(file.error);
    config = *file.value;
  }
  const Result<NodeConfig> environment = palpate::config_from_environment();
  if (!environment) return Options::fail(environment.error);
  config = palpate::merge(palpate::merge(config, *environment.value), command_line.flags);
  return palpate::make_options(config);
}

void tell_of(const palpate::ProbeFiles& files) {
  for (const palpate::QualifiedProbe& probe : files.all()) {
    const std::string& name = probe.described.name();
    spdlog::info("probe {}: {}", name.empty() ? "of any other name" : palpate::printable(name),
                 probe.file);
    if (probe.described.verdict() == palpate::v1::QUALIFICATION_VERDICT_INSUFFICIENT) {
      spdlog::warn("{}: its qualification was insufficient", probe.file);
    }
  }
}

int serve(const NodeOptions& options, const palpate::NodeKeys& keys,
          palpate::ProbeFiles probe_files) {
  const int stop_fd = palpate::take_stop_signals();
  const int reload_fd = palpate::take_reload_signal();
  bool unfinished = false;
  try {
    tell_of(probe_files);
    palpate::Node node(options, keys, std::move(probe_files));
    spdlog::info("contacts on {}, results on {}{}", node.contacts_address(), node.results_address(),
                 keys.own ? ", CURVE" : "");
    node.run(stop_fd, reload_fd);
    unfinished = node.unfinished_count() > 0;
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return kFailed;
  }
  ::close(stop_fd);
  // Workers that still compute must not run into the destruction of static objects.
  if (unfinished) std::quick_exit(kStopped);
  return kStopped;
}

}  // namespace

int main(int argc, char** argv) {
  palpate::silence_protobuf();
  // If the reader of our log or output goes away, the write fails; the node must go on.
  std::signal(SIGPIPE, SIG_IGN);
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(
      "palpate-node", std::make_shared<palpate::LogSink>(STDERR_FILENO)));
  CLI::App app(
      "Recognises and locates curved parts: contacts in, recognitions out.\n"
      "Each option may also be set by PALPATE_<NAME> in the environment and by <name> in the\n"
      "configuration file, which PALPATE_CONFIG may name. Flag before environment before file "
      "before\n"
      "default.\n"
      "Exit codes: 0 stopped as asked, 1 failed at run time, 2 usage, 6 configuration.",
      "palpate-node");
  app.option_defaults()->disable_flag_override();  // --insecure=maybe is a mistake
  CommandLine command_line;
  app.add_option("--config", command_line.config_file, "File of options, protobuf text format")
      ->type_name("FILE");
  app.add_flag("--check-config", command_line.check_config, "Check the options and exit");
  app.add_flag("--print-config", command_line.print_config,
               "Print all options as a configuration file and exit");
  app.set_version_flag("--version", PALPATE_VERSION);
  add_flags(app, command_line.flags);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kStopped : kUsage;
  }

  const Result<NodeOptions> options = all_options(command_line);
  if (!options) {
    spdlog::error("{}", options.error);
    return kBadConfiguration;
  }
  spdlog::set_level(spdlog::level::from_str(options.value->log_level));
  for (const std::string& sentence : palpate::unread_variables()) spdlog::warn("{}", sentence);
  const Result<palpate::NodeKeys> keys =
      palpate::read_node_keys(options.value->curve_secret_key, options.value->allow_clients);
  if (!keys) {
    spdlog::error("{}", keys.error);
    return kBadConfiguration;
  }
  Result<palpate::ProbeFiles> probe_files = palpate::ProbeFiles::read(options.value->probe_files);
  if (!probe_files) {
    spdlog::error("{}", probe_files.error);
    return kBadConfiguration;
  }
  if (command_line.print_config) {
    std::fputs(palpate::to_text(palpate::to_config(*options.value)).c_str(), stdout);
    if (const std::string why = palpate::flush_standard_output(); !why.empty()) {
      spdlog::error("{}", why);
      return kFailed;
    }
  }
  if (command_line.print_config || command_line.check_config) return kStopped;
  return serve(*options.value, *keys.value, *std::move(probe_files.value));
}
