#include "node/wire/socket_monitor.h"

#include <atomic>
#include <cstring>

namespace palpate {
namespace {

std::string unique_monitor_address() {
  static std::atomic<std::uint64_t> count{0};
  return "inproc://palpate-socket-monitor-" + std::to_string(count.fetch_add(1));
}

}  // namespace

SocketMonitor::SocketMonitor(zmq::context_t& context, zmq::socket_t& socket, int events)
    : socket_(socket), events_(context, zmq::socket_type::pair) {
  const std::string monitor = unique_monitor_address();
  if (zmq_socket_monitor(socket_.handle(), monitor.c_str(), events) != 0) throw zmq::error_t();
  // No limit: libzmq's thread would block on a full event queue, and a flood of peers could fill
  // it.
  events_.set(zmq::sockopt::rcvhwm, 0);
  events_.set(zmq::sockopt::linger, 0);
  events_.connect(monitor);
}

SocketMonitor::~SocketMonitor() { zmq_socket_monitor(socket_.handle(), nullptr, 0); }

std::optional<SocketEvent> SocketMonitor::next() {
  // Each event has two frames: number and value, then the address.
  zmq::message_t frame;
  if (zmq_msg_recv(frame.handle(), events_.handle(), ZMQ_DONTWAIT) < 0) return std::nullopt;
  SocketEvent told;
  if (frame.size() >= sizeof told.event + sizeof told.value) {
    std::memcpy(&told.event, frame.data(), sizeof told.event);
    std::memcpy(&told.value, frame.data<char>() + sizeof told.event, sizeof told.value);
  }
  while (frame.more() && zmq_msg_recv(frame.handle(), events_.handle(), ZMQ_DONTWAIT) >= 0) {
    told.address = frame.to_string();
  }
  return told;
}

}  // namespace palpate
