// Serves the page and its live feed over HTTP, on the thread of the io_context.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <memory>
#include <vector>

#include "node/tool/view/http_border.h"
#include "node/tool/view/live_feed.h"
#include "node/tool/view/live_session.h"

namespace palpate {

class WebServer {
 public:
  /// Binds. Throws boost::system::system_error on failure. `state` must outlive the server.
  WebServer(boost::asio::io_context& io, const HostPort& listen, LiveState& state);

  /// The port bound; for port 0 the one that the system chose.
  std::uint16_t port() const { return port_; }

  /// Number of browsers connected to the live feed.
  std::size_t viewers() const { return static_cast<std::size_t>(live_count_.use_count()) - 1; }

  LiveFeed& feed() { return feed_; }
  LiveState& state() { return state_; }

  /// Takes a browser's connection over from HTTP. Returns false if there are too many.
  bool add_viewer(boost::beast::tcp_stream&& stream, const LiveSession::Request& request);

 private:
  void accept();
  void tick();

  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer ticks_;         ///< of the viewers
  boost::asio::steady_timer accept_again_;  ///< its own: a tick would cancel the wait
  std::uint16_t port_ = 0;
  LiveState& state_;
  LiveFeed feed_;
  // Each connection holds a copy while it lives, so the use counts are the numbers of connections.
  std::shared_ptr<void> http_count_ = std::make_shared<int>();
  std::shared_ptr<void> live_count_ = std::make_shared<int>();
  std::vector<std::weak_ptr<LiveSession>> sessions_;
};

}  // namespace palpate
