// palpate-gateway: forwards contacts, recognitions and status of a cell to the plant's streams, and
// recognises what the streams hold. Exit codes: 0 stopped by a signal, 1 failed at run time, 2
// usage.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "node/client/connection.h"
#include "node/gateway/gateway.h"
#include "node/process/log_sink.h"
#include "node/process/number_checks.h"
#include "node/process/quiet_protobuf.h"
#include "node/process/stop_signals.h"
#include "node/wire/key_flags.h"

namespace {

using namespace palpate;
using gateway::GatewayOptions;

enum ExitCode { kStopped = 0, kFailed = 1, kUsage = 2 };

struct CommandLine {
  GatewayOptions gateway;
  gateway::UpwardOptions up;
  std::string urls = "nats://127.0.0.1:4222";
  std::string from;
  // Not "recognition": recognisers of the plant answer to the same subjects.
  std::vector<std::string> carry{"contact", "status"};
  std::vector<std::string> take;
  std::string own_key;
  std::string node_key;
  std::string log_level = "info";
};

void add_plant_options(CLI::App& app, CommandLine& line) {
  gateway::PlantOptions& plant = line.gateway.plant;
  app.add_option("--plant", line.urls, "NATS servers, their URLs with commas between")
      ->capture_default_str()
      ->type_name("URLS");
  app.add_option("--credentials", plant.credentials, "NATS: a user's credentials")
      ->check(CLI::ExistingFile)
      ->type_name("FILE");
  app.add_option("--tls-ca", plant.tls_ca, "TLS: certificates to trust; sets TLS on")
      ->check(CLI::ExistingFile)
      ->type_name("FILE");
  CLI::Option* key = app.add_option("--tls-key", plant.tls_key, "TLS: key of --tls-cert")
                         ->check(CLI::ExistingFile)
                         ->type_name("FILE");
  app.add_option("--tls-cert", plant.tls_certificate, "TLS: this gateway's certificate")
      ->check(CLI::ExistingFile)
      ->needs(key)
      ->type_name("FILE");
  gateway::StreamLimits& streams = line.gateway.streams;
  app.add_option("--replicas", streams.replicas, "Of streams that it makes: servers that hold each")
      ->check(CLI::Range(1, 5))
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--contacts-max-age-h", streams.contacts_max_age_h,
                 "Of streams that it makes: contacts are kept so long; 0 = for ever [h]")
      ->check(number_within(0.0, 1e6))
      ->capture_default_str()
      ->type_name("HOURS");
  app.add_option("--max-bytes", streams.max_bytes,
                 "Of streams that it makes: size of each, the oldest go; -1 = no limit [bytes]")
      ->check(CLI::Range(std::int64_t{-1}, std::numeric_limits<std::int64_t>::max()))
      ->capture_default_str()
      ->type_name("BYTES");
  app.add_option("--duplicate-window-s", streams.duplicate_window_s,
                 "Of streams that it makes: what comes twice within it is stored once [s]")
      ->check(number_within(1e-3, 1e9))
      ->capture_default_str()
      ->type_name("S");
}

void add_options(CLI::App& app, CommandLine& line) {
  app.set_config("--config", "", "File of these options, NAME = VALUE a line")->type_name("FILE");
  app.allow_config_extras(CLI::config_extras_mode::error);
  app.set_version_flag("--version", PALPATE_VERSION);
  app.add_option("--name", line.gateway.name, "Name, as in palpate.<cell>.gateway.<name>")
      ->capture_default_str()
      ->type_name("NAME");
  add_plant_options(app, line);
  CLI::Option* from =
      app.add_option("--from", line.from,
                     "Up: results endpoint of a cell's node; or, without a node, an endpoint to "
                     "bind for its probes: bind:ADDRESS")
          ->type_name("ENDPOINT");
  app.add_option("--cell", line.up.cell, "Up: the cell's name")->type_name("NAME");
  from->needs("--cell");
  app.add_option("--carry", line.carry,
                 "Up: what of contact, recognition, status; recognition where no "
                 "recogniser of the plant answers: their subjects are the same")
      ->check(CLI::IsMember({"contact", "recognition", "status"}))
      ->capture_default_str()
      ->type_name("KINDS");
  app.add_option("--spool", line.up.spool_folder,
                 "Up: folder for what waits while the plant is away")
      ->type_name("FOLDER");
  from->needs("--spool");
  app.add_option("--spool-bytes", line.up.spool_bytes, "Up: bound of it, the oldest go [bytes]")
      ->check(CLI::Range(std::uint64_t{1} << 16, std::uint64_t{1} << 50))
      ->capture_default_str()
      ->type_name("BYTES");
  add_key_flags(app, line.own_key, "Up, CURVE: this gateway's secret key file (palpate keygen)",
                line.node_key, "Up, CURVE: the node's public key file")
      .own->needs(from);
  CLI::Option* take =
      app.add_option(
             "--take", line.take,
             "Down: CELL, or CELL:PARTITION of the server's mapping, to recognise; repeated, "
             "and by several gateways: each is taken by one at a time")
          ->type_name("PLACE");
  app.add_option("--most-places", line.gateway.most_places, "Down: so many of them at a time")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--node", line.gateway.node.program, "Down: the recogniser's program")
      ->capture_default_str()
      ->type_name("PROGRAM");
  app.add_option("--node-config", line.gateway.node.config, "Down: its configuration file")
      ->check(CLI::ExistingFile)
      ->type_name("FILE");
  app.add_option(
         "--run-folder", line.gateway.node.folder,
         "Down: folder of its endpoints, ipc://FOLDER/CELL-PARTITION.results; for this user only")
      ->check(CLI::ExistingDirectory)
      ->type_name("FOLDER");
  take->needs("--run-folder");
  app.add_option("--max-message-bytes", line.gateway.node.max_message_bytes,
                 "Down: longest contact message [bytes]")
      ->check(CLI::Range(1024, 100'000'000))
      ->capture_default_str()
      ->type_name("BYTES");
  app.add_option("--log-level", line.log_level, "trace, debug, info, warning, error or off")
      ->check(CLI::IsMember({"trace", "debug", "info", "warning", "error", "off"}))
      ->capture_default_str()
      ->type_name("LEVEL");
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (;;) {
    const std::size_t end = text.find(at, begin);
    parts.push_back(text.substr(begin, end - begin));
    if (end == std::string::npos) return parts;
    begin = end + 1;
  }
}

/// Completes and checks the options. Returns an empty string or an error.
std::string complete(CommandLine& line) {
  GatewayOptions& options = line.gateway;
  options.plant.urls = split(line.urls, ',');
  options.plant.client_name = "palpate-gateway " + options.name;
  if (!is_valid_name(options.name)) return "--name: \"" + options.name + "\" is no name";
  if (line.from.empty() && line.take.empty()) return "one of --from and --take is needed";
  if (!line.from.empty()) {
    const Result<Endpoint> endpoint = parse_endpoint(line.from, /*bind_by_default=*/false);
    if (!endpoint) return "--from: " + endpoint.error;
    line.up.endpoint = *endpoint.value;
    if (endpoint.value->bind && !is_local(*endpoint.value)) {
      return "--from: binds beyond this machine: anybody could publish. Let a node do it, with "
             "CURVE";
    }
    if (!is_valid_name(line.up.cell)) return "--cell: \"" + line.up.cell + "\" is no name";
    const auto carries = [&](const char* kind) {
      return std::find(line.carry.begin(), line.carry.end(), kind) != line.carry.end();
    };
    if (carries("contact")) line.up.kinds.push_back(TopicKind::Contact);
    if (carries("recognition")) line.up.kinds.push_back(TopicKind::Recognition);
    if (carries("status")) line.up.kinds.push_back(TopicKind::Status);
    if (!line.own_key.empty()) {
      Result<CurveClient> curve = client::read_curve_client(line.own_key, line.node_key);
      if (!curve) return curve.error;
      line.up.curve = std::move(*curve.value);
    }
    options.up = line.up;
  }
  for (const std::string& text : line.take) {
    const std::vector<std::string> parts = split(text, ':');
    if (parts.size() > 2 || !is_valid_name(parts.front()) ||
        (parts.size() == 2 && !is_valid_name(parts.back()))) {
      return "--take: \"" + text + "\" is no CELL or CELL:PARTITION";
    }
    options.places.push_back({parts.front(), parts.size() == 2 ? parts.back() : std::string()});
  }
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  silence_protobuf();
  std::signal(SIGPIPE, SIG_IGN);
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(
      "palpate-gateway", std::make_shared<LogSink>(STDERR_FILENO)));
  CLI::App app(
      "Between a cell and the streams of a plant (NATS JetStream).\n"
      "Up (--from): the cell's contacts, recognitions and status, stored once each.\n"
      "Down (--take): recognises what is stored, by a node of its own, and stores the answers.\n"
      "Exit codes: 0 stopped as asked, 1 failed at run time, 2 usage.",
      "palpate-gateway");
  app.option_defaults()->disable_flag_override();  // --flag=maybe is a mistake
  CommandLine line;
  add_options(app, line);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kStopped : kUsage;
  }
  spdlog::set_level(spdlog::level::from_str(line.log_level));
  if (const std::string why = complete(line); !why.empty()) {
    spdlog::error("{}", why);
    return kUsage;
  }
  const int stop_fd = take_stop_signals();
  try {
    gateway::Gateway gateway(line.gateway);
    gateway.run(stop_fd);
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return kFailed;
  }
  return kStopped;
}
