// palpate view: a live picture in the browser.
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <iostream>
#include <memory>

#include "node/client/result_subscriber.h"
#include "node/process/clock.h"
#include "node/process/stop_signals.h"
#include "node/tool/commands/command.h"
#include "node/tool/view/web_server.h"

namespace palpate {
namespace {

namespace asio = boost::asio;

struct ViewCommand {
  Connection connection{std::string(kDefaultResultsEndpoint), "", ""};
  std::string listen = "127.0.0.1:8090";
  bool insecure = false;
};

/// Takes what comes on the bus into the state, in the io_context's thread.
class BusReader {
 public:
  BusReader(asio::io_context& io, const client::ResultSubscriberOptions& options, LiveState& state)
      : io_(io),
        subscriber_(options),
        state_(state),
        descriptor_(io, subscriber_.socket().get(zmq::sockopt::fd)) {}

  // ZeroMQ's descriptor is not asio's to close.
  ~BusReader() { descriptor_.release(); }

  /// ZeroMQ's descriptor tells of news once only: everything is taken before it is waited for.
  void read() {
    // Browsers get their turn after so many messages.
    constexpr int kMessagesPerTurn = 200;
    for (int count = 0; count < kMessagesPerTurn; ++count) {
      const client::ReceivedResult result = subscriber_.receive(std::chrono::milliseconds(0));
      if (!result) {
        descriptor_.async_wait(asio::posix::stream_descriptor::wait_read,
                               [this](const boost::system::error_code& error) {
                                 if (!error) read();
                               });
        return;
      }
      take(result);
    }
    asio::post(io_, [this] { read(); });
  }

 private:
  void take(const client::ReceivedResult& result) {
    const auto now = std::chrono::steady_clock::now();
    if (result.contact != nullptr) state_.take(*result.contact, now);
    if (result.recognition != nullptr) state_.take(*result.recognition, now, unix_time_ns());
    if (result.status != nullptr) state_.take(*result.status, now);
  }

  asio::io_context& io_;
  client::ResultSubscriber subscriber_;
  LiveState& state_;
  asio::posix::stream_descriptor descriptor_;
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
  const int stop_fd = take_stop_signals();
  asio::io_context io(1);
  asio::posix::stream_descriptor stop(io, stop_fd);
  stop.async_wait(asio::posix::stream_descriptor::wait_read,
                  [&io](const boost::system::error_code&) { io.stop(); });
  LiveState state;
  try {
    BusReader bus(io, options, state);
    WebServer server(io, *listen, state);
    bus.read();
    std::cout << "palpate view: " << url_of(*listen, server.port()) << std::endl;
    io.run();
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
                         "probes. Prints the page's address; any number of browsers may look on.");
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
