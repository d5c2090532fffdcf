// One browser's WebSocket.
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

/// A browser says which group it wants ("" = the one that is touched) each time it has drawn the
/// last message; only then does it get the next. A browser that is slow, hidden or frozen is sent
/// nothing and costs nothing; one that no longer answers pings is let go.
class LiveSession : public std::enable_shared_from_this<LiveSession> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;

  /// `count` lives as long as the session.
  LiveSession(boost::beast::tcp_stream&& stream, LiveFeed& feed, std::shared_ptr<void> count);

  void accept(const Request& request);

  /// Sends what is new, if the browser is ready and it is time.
  void tick(SteadyTime now);

 private:
  void read();
  void on_read(boost::beast::error_code error);

  boost::beast::websocket::stream<boost::beast::tcp_stream, false> socket_;  // never deflates
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
