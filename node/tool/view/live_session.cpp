#include "node/tool/view/live_session.h"

#include <boost/asio/buffer.hpp>
#include <string_view>

#include "node/wire/topics.h"

namespace palpate {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
using namespace std::chrono_literals;

// Thirty pictures a second look continuous.
constexpr auto kLeastInterval = 30ms;
constexpr auto kHandshakeTime = 5s;
// A browser is pinged after half of this time of silence and disconnected after all of it.
constexpr auto kIdleTime = 20s;

}  // namespace

LiveSession::LiveSession(beast::tcp_stream&& stream, LiveFeed& feed, std::shared_ptr<void> count)
    : socket_(std::move(stream)), feed_(feed), count_(std::move(count)) {
  beast::get_lowest_layer(socket_).expires_never();  // the WebSocket has its own timeouts
  socket_.set_option(websocket::stream_base::timeout{kHandshakeTime, kIdleTime, true});
  socket_.read_message_max(kMaxNameLength);
  socket_.text(true);
  socket_.auto_fragment(false);  // messages are complete, so one frame each
}

void LiveSession::accept(const Request& request) {
  socket_.async_accept(request, [self = shared_from_this()](beast::error_code error) {
    if (error) return;
    self->is_open_ = true;
    self->read();
  });
}

void LiveSession::read() {
  socket_.async_read(incoming_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    self->on_read(error);
  });
}

void LiveSession::on_read(beast::error_code error) {
  if (error) {
    is_open_ = false;
    return;
  }
  std::string wanted = beast::buffers_to_string(incoming_.data());
  incoming_.consume(incoming_.size());
  if (!wanted.empty() && !is_valid_name(wanted)) {
    is_open_ = false;
    socket_.async_close(websocket::close_code::policy_error,
                        [self = shared_from_this()](beast::error_code) {});
    return;
  }
  viewer_.wanted = std::move(wanted);
  is_ready_ = true;
  read();
}

void LiveSession::tick(SteadyTime now) {
  if (!is_open_ || !is_ready_ || is_writing_ || now - last_sent_ < kLeastInterval) return;
  outgoing_ = feed_.next_message(viewer_, now);
  if (outgoing_.empty()) return;
  last_sent_ = now;
  is_ready_ = false;
  is_writing_ = true;
  socket_.async_write(boost::asio::buffer(outgoing_),
                      [self = shared_from_this()](beast::error_code error, std::size_t) {
                        self->is_writing_ = false;
                        self->outgoing_ = {};
                        if (error) self->is_open_ = false;
                      });
}

}  // namespace palpate
