// palpate view: a live picture in the browser.
#include <boost/system/system_error.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "node/client/result_subscriber.h"
#include "node/process/stop_signals.h"
#include "node/tool/commands/command.h"
#include "node/tool/view/http_border.h"
#include "node/tool/view/live_view.h"

namespace palpate {
namespace {

struct ViewCommand {
  Connection connection{std::string(kDefaultResultsEndpoint), "", ""};
  std::string listen = "127.0.0.1:8090";
  bool insecure = false;
};

std::string url_of(const HostPort& listen, std::uint16_t port) {
  const bool is_ipv6 = listen.host.find(':') != std::string::npos;
  return "http://" + (is_ipv6 ? "[" + listen.host + "]" : listen.host) + ":" + std::to_string(port);
}

int run(const ViewCommand& command) {
  const auto curve = curve_of(command.connection);
  if (!curve) return complain(curve.error, kUsage);
  const std::optional<HostPort> listen = parse_listen_address(command.listen);
  if (!listen) {
    return complain("--listen " + command.listen + ": expected ADDRESS:PORT, an IP address",
                    kUsage);
  }
  if (!is_loopback_host(listen->host) && !command.insecure) {
    return complain("--listen " + command.listen +
                        ": others could look on, unencrypted and unasked; --insecure permits it",
                    kUsage);
  }
  client::ResultSubscriberOptions options;
  options.endpoint = command.connection.endpoint;
  options.status = true;
  options.contacts = true;
  options.curve = *curve.value;
  try {
    serve_live_view(options, *listen, take_stop_signals(), [&](std::uint16_t port) {
      std::cout << "palpate view: " << url_of(*listen, port) << std::endl;
    });
  } catch (const std::invalid_argument& error) {
    return complain(error.what(), kUsage);
  } catch (const boost::system::system_error& error) {
    return complain("--listen " + command.listen + ": " + error.code().message(), kFailed);
  }
  return kDone;
}

}  // namespace

void add_view_command(CLI::App& app, int& exit_code) {
  auto view = std::make_shared<ViewCommand>();
  CLI::App* command =
      app.add_subcommand("view",
                         "Show touch and recognition live in a browser: points, curve, 95 % band, "
                         "rivals, what to do next,\n"
                         "probes. Prints the page's address; up to " +
                             std::to_string(kMostViewers) + " browsers may look on.");
  add_connection_flags(*command, "--results", "The recognizer's results endpoint",
                       view->connection);
  command->add_option("--listen", view->listen, "Address and port of the page; port 0 = any")
      ->capture_default_str()
      ->type_name("ADDRESS:PORT");
  command->add_flag("--insecure", view->insecure,
                    "Permit an address that other machines can reach: anybody there can look on");
  command->callback([view, &exit_code] { exit_code = run(*view); });
}

}  // namespace palpate
