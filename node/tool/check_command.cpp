// palpate check: listens to probes in the recognizer's place and says what is wrong with their streams.
#include <iostream>
#include <memory>

#include "node/clock.h"
#include "node/endpoint.h"
#include "node/node_keys.h"
#include "node/stop_signals.h"
#include "node/tool/command.h"
#include "node/tool/stream_check.h"

namespace palpate {
namespace {

struct CheckCommand {
  std::string contacts{kDefaultContactsEndpoint};
  std::string curve_secret_key;
  std::string allow_clients;
  bool insecure = false;
  double seconds = 5.0;
};

const char* name_of(Severity severity) {
  switch (severity) {
    case Severity::Error:
      return "ERROR  ";
    case Severity::Warning:
      return "WARNING";
    case Severity::Note:
      break;
  }
  return "note   ";
}

int run(const CheckCommand& command) {
  const Result<Endpoint> endpoint = parse_endpoint(command.contacts, /*bind_by_default=*/true);
  if (!endpoint) {
    return complain(endpoint.error, kUsage);
  }
  if (endpoint.value->bind && !is_local(*endpoint.value) && command.curve_secret_key.empty() &&
      !command.insecure) {
    return complain(command.contacts + " is open to the network: give --curve-secret-key and "
                                       "--allow-clients, or say --insecure",
                    kUsage);
  }
  const Result<NodeKeys> keys = read_node_keys(command.curve_secret_key, command.allow_clients);
  if (!keys) {
    return complain(keys.error, kUsage);
  }
  const int stop_fd = take_stop_signals();
  zmq::context_t context(1);
  std::optional<ZapHandler> zap = make_zap_handler(context, *keys.value);
  SocketSettings settings;
  settings.curve_server = keys.value->own;
  zmq::socket_t socket = make_socket(context, zmq::socket_type::sub, settings);
  socket.set(zmq::sockopt::subscribe, "");
  if (const std::string error = attach(socket, *endpoint.value); !error.empty()) {
    return complain(error + " (is the recognizer running? stop it: the check takes its place)",
                    kFailed);
  }
  std::cerr << "listening on " << to_string(*endpoint.value) << " for " << command.seconds
            << " s: touch something\n";
  StreamCheck check;
  TwoFrames frames;
  std::vector<zmq::pollitem_t> items{{socket.handle(), 0, ZMQ_POLLIN, 0}};
  if (zap) {
    items.push_back({zap->socket().handle(), 0, ZMQ_POLLIN, 0});
  }
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(command.seconds);
  while (!stop_requested(stop_fd) && std::chrono::steady_clock::now() < end) {
    constexpr int kStepMs = 50;
    poll(items, kStepMs);
    if (zap) {
      zap->serve();
    }
    while (receive_now(socket, frames)) {
      check.take(frames.frame_count, frames.topic.to_string_view(), frames.payload.to_string_view(),
                 unix_time_ns());
    }
  }
  if (zap && zap->denied_count() > 0) {
    std::cout << name_of(Severity::Error) << "  " << zap->denied_count()
              << " connections turned away: their keys are not in " << command.allow_clients << "\n";
  }
  if (check.messages() == 0) {
    return complain("no message came: does the probe connect to " + endpoint.value->address +
                        " with a PUB socket?",
                    kFailed);
  }
  bool good = true;
  for (const Finding& finding : check.findings()) {
    std::cout << name_of(finding.severity) << "  "
              << (finding.probe.empty() ? "" : finding.probe + ": ") << finding.what
              << (finding.cure.empty() ? "" : "\n         " + finding.cure) << "\n";
    good = good && finding.severity != Severity::Error;
  }
  std::cout << (good ? "fit for the recognizer\n" : "not fit for the recognizer yet\n");
  return good ? kDone : kFailed;
}

}  // namespace

void add_check_command(CLI::App& app, int& exit_code) {
  auto check = std::make_shared<CheckCommand>();
  CLI::App* command = app.add_subcommand(
      "check",
      "Listen to a probe's stream in the recognizer's place and tell its author what is wrong with it:\n"
      "format, units, spacing, noise, lift-offs, gaps, stamps. Exit code 1 where there is an error.");
  command->add_option("--contacts", check->contacts, "Bind here, as the recognizer would")
      ->capture_default_str()
      ->type_name("ENDPOINT");
  CLI::Option* secret = command->add_option("--curve-secret-key", check->curve_secret_key,
                                            "CURVE: the recognizer's secret key file");
  secret->type_name("FILE");
  CLI::Option* allowed = command->add_option("--allow-clients", check->allow_clients,
                                             "CURVE: file of the public keys that may connect");
  allowed->type_name("FILE");
  secret->needs(allowed);
  allowed->needs(secret);
  command->add_flag("--insecure", check->insecure, "Permit a bind beyond this machine without CURVE");
  command->add_option("--seconds", check->seconds, "How long to listen [s]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->type_name("S");
  command->callback([check, &exit_code] { exit_code = run(*check); });
}

}  // namespace palpate
