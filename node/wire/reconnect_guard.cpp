#include "node/wire/reconnect_guard.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>

namespace palpate {
namespace {

// Longer than the longest pause before libzmq's own retry, which also is announced at once.
constexpr std::chrono::milliseconds kPatience{100};

std::string unique_monitor_address() {
  static std::atomic<std::uint64_t> count{0};
  return "inproc://palpate-reconnect-guard-" + std::to_string(count.fetch_add(1));
}

}  // namespace

ReconnectGuard::ReconnectGuard(zmq::context_t& context, zmq::socket_t& socket,
                               std::vector<std::string> addresses)
    : socket_(socket), addresses_(std::move(addresses)), events_(context, zmq::socket_type::pair) {
  const std::string monitor = unique_monitor_address();
  const int events = ZMQ_EVENT_DISCONNECTED | ZMQ_EVENT_CONNECT_RETRIED |
                     ZMQ_EVENT_CONNECT_DELAYED | ZMQ_EVENT_CONNECTED;
  if (zmq_socket_monitor(socket_.handle(), monitor.c_str(), events) != 0) throw zmq::error_t();
  events_.set(zmq::sockopt::linger, 0);
  events_.connect(monitor);
}

ReconnectGuard::~ReconnectGuard() { zmq_socket_monitor(socket_.handle(), nullptr, 0); }

bool ReconnectGuard::tend(std::chrono::steady_clock::time_point now) {
  // Each event is two frames: number and value, then the address.
  zmq::message_t frame;
  while (zmq_msg_recv(frame.handle(), events_.handle(), ZMQ_DONTWAIT) >= 0) {
    std::uint16_t event = 0;
    if (frame.size() >= sizeof(event)) std::memcpy(&event, frame.data(), sizeof(event));
    if (!frame.more()) continue;
    if (zmq_msg_recv(frame.handle(), events_.handle(), ZMQ_DONTWAIT) < 0) break;
    if (event == ZMQ_EVENT_DISCONNECTED) {
      silent_since_.emplace(frame.to_string(), now);
    } else {
      silent_since_.erase(frame.to_string());
    }
  }
  bool reconnected = false;
  for (auto entry = silent_since_.begin(); entry != silent_since_.end();) {
    if (now - entry->second < kPatience) {
      ++entry;
      continue;
    }
    reconnected = reconnect(entry->first) || reconnected;
    entry = silent_since_.erase(entry);
  }
  return reconnected;
}

// libzmq tells resolved addresses: where ours was a name, all are connected again.
bool ReconnectGuard::reconnect(const std::string& told) {
  const bool known = std::find(addresses_.begin(), addresses_.end(), told) != addresses_.end();
  bool reconnected = false;
  for (const std::string& address : addresses_) {
    if (known && address != told) continue;
    (void)zmq_disconnect(socket_.handle(), address.c_str());
    reconnected = zmq_connect(socket_.handle(), address.c_str()) == 0 || reconnected;
  }
  return reconnected;
}

}  // namespace palpate
