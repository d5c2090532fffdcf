#include "node/tool/view/live_view.h"

#include <sys/resource.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>

#include "node/process/clock.h"
#include "node/tool/view/live_state.h"
#include "node/tool/view/web_server.h"

namespace palpate {
namespace {

/// Takes what comes on the bus into the state, in the io_context's thread.
class BusReader {
 public:
  BusReader(boost::asio::io_context& io, const client::ResultSubscriberOptions& options,
            LiveState& state)
      : io_(io),
        subscriber_(options),
        state_(state),
        pause_(io),
        descriptor_(io, subscriber_.socket().get(zmq::sockopt::fd)) {}

  // ZeroMQ's descriptor is not asio's to close.
  ~BusReader() { descriptor_.release(); }

  /// ZeroMQ's descriptor tells of news once only: everything is taken before it is waited for.
  void read() {
    // Browsers get their turn after so many messages.
    constexpr int kMessagesPerTurn = 200;
    for (int count = 0; count < kMessagesPerTurn; ++count) {
      const client::ReceivedResult result = subscriber_.receive(std::chrono::milliseconds(0));
      if (!result) return wait();
      take(result);
    }
    boost::asio::post(io_, [this] { read(); });
  }

 private:
  /// To be woken for every message of many costs more than the message does.
  void wait() {
    constexpr std::chrono::milliseconds kPause(5);  // a tenth of what an eye takes for at once
    pause_.expires_after(kPause);
    pause_.async_wait([this](const boost::system::error_code& stopped) {
      if (stopped) return;
      descriptor_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                             [this](const boost::system::error_code& error) {
                               if (!error) read();
                             });
    });
  }

  void take(const client::ReceivedResult& result) {
    const auto now = std::chrono::steady_clock::now();
    if (result.contact != nullptr) state_.take(*result.contact, now);
    if (result.recognition != nullptr) state_.take(*result.recognition, now, unix_time_ns());
    if (result.status != nullptr) state_.take(*result.status, now);
  }

  boost::asio::io_context& io_;
  client::ResultSubscriber subscriber_;
  LiveState& state_;
  boost::asio::steady_timer pause_;
  boost::asio::posix::stream_descriptor descriptor_;
};

/// A recognizer on the same machine goes first: whoever looks on waits a moment. ZeroMQ's threads,
/// which are started later, inherit it.
void give_way() {
  constexpr int kNice = 5;  // a third of another one's share where all cores are busy
  // Where that fails it is as before.
  (void)setpriority(PRIO_PROCESS, 0, kNice);
}

}  // namespace

void serve_live_view(const client::ResultSubscriberOptions& bus, const HostPort& listen,
                     int stop_fd, const std::function<void(std::uint16_t port)>& on_bound) {
  give_way();
  boost::asio::io_context io(1);
  boost::asio::posix::stream_descriptor stop(io, stop_fd);
  stop.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                  [&io](const boost::system::error_code&) { io.stop(); });
  LiveState state;
  BusReader reader(io, bus, state);
  WebServer server(io, listen, state);
  reader.read();
  on_bound(server.port());
  io.run();
}

}  // namespace palpate
