// The WebSocket of one browser.
#pragma once

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "node/tool/view/live_feed.h"

namespace palpate {

/// After a browser has drawn a message it names the group that it wants ("" = the one being
/// touched); only then is it sent the next message. So a slow, hidden or frozen browser is sent
/// nothing and costs nothing. A browser that no longer answers pings is disconnected.
class LiveSession : public std::enable_shared_from_this<LiveSession> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;

  /// `count` lives as long as the session; its use count is the number of sessions.
  LiveSession(boost::beast::tcp_stream&& stream, LiveFeed& feed, std::shared_ptr<void> count);

  void accept(const Request& request);

  /// Sends what is new, if the browser is ready and the interval has passed.
  void tick(SteadyTime now);

 private:
  void read();
  void on_read(boost::beast::error_code error);

  boost::beast::websocket::stream<boost::beast::tcp_stream, false> socket_;  // without compression
  LiveFeed& feed_;
  std::shared_ptr<void> count_;
  boost::beast::flat_buffer incoming_;
  std::string outgoing_;
  Viewer viewer_;
  SteadyTime last_sent_;
  bool is_ready_ = false;
  bool is_writing_ = false;
  bool is_open_ = false;
};

}  // namespace palpate
