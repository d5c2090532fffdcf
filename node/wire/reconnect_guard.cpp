#include "node/wire/reconnect_guard.h"

#include <algorithm>

namespace palpate {
namespace {

// Longer than the longest pause before libzmq's own retry, which it also announces at once.
constexpr std::chrono::milliseconds kPatience{100};

}  // namespace

ReconnectGuard::ReconnectGuard(zmq::context_t& context, zmq::socket_t& socket,
                               std::vector<std::string> addresses)
    : socket_(socket),
      addresses_(std::move(addresses)),
      monitor_(context, socket,
               ZMQ_EVENT_DISCONNECTED | ZMQ_EVENT_CONNECT_RETRIED | ZMQ_EVENT_CONNECT_DELAYED |
                   ZMQ_EVENT_CONNECTED) {}

bool ReconnectGuard::tend(std::chrono::steady_clock::time_point now) {
  while (const auto told = monitor_.next()) {
    if (told->event == ZMQ_EVENT_DISCONNECTED) {
      silent_since_.emplace(told->address, now);
    } else {
      silent_since_.erase(told->address);
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

// libzmq reports resolved addresses. If ours is a host name, all addresses are connected again.
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
