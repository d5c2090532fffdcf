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

/// Reads messages from the bus into the state, on the io_context's thread.
class BusReader {
 public:
  BusReader(boost::asio::io_context& io, const client::ResultSubscriberOptions& options,
            LiveState& state)
      : io_(io),
        subscriber_(options),
        state_(state),
        pause_(io),
        descriptor_(io, subscriber_.socket().get(zmq::sockopt::fd)) {}

  // ZeroMQ's descriptor must not be closed by asio.
  ~BusReader() { descriptor_.release(); }

  /// ZeroMQ's descriptor signals news only once, so all messages are read before waiting for it.
  void read() {
    // After this many messages browsers get their turn.
    constexpr int kMessagesPerTurn = 200;
    for (int count = 0; count < kMessagesPerTurn; ++count) {
      const client::ReceivedResult result = subscriber_.receive(std::chrono::milliseconds(0));
      if (!result) return wait();
      take(result);
    }
    boost::asio::post(io_, [this] { read(); });
  }

 private:
  /// Waiting for a moment first: waking up for every single message would cost more than the
  /// message.
  void wait() {
    // A tenth of what the eye perceives as simultaneous.
    constexpr std::chrono::milliseconds kPause(5);
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

/// Lowers the priority of this process, so that a recognizer on the same machine comes first.
/// ZeroMQ's threads, which start later, inherit it.
void give_way() {
  constexpr int kNice = 5;  // a third of another process's share when all cores are busy
  // Failure is harmless.
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
