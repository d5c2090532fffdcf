#include "node/security/peer_guard.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <utility>

namespace palpate {
namespace {

/// Address and port, or the process at the other end of an ipc connection.
std::string name_of_peer(int descriptor) {
  sockaddr_storage address{};
  socklen_t length = sizeof address;
  if (::getpeername(descriptor, reinterpret_cast<sockaddr*>(&address), &length) != 0) {
    return "a peer that has left";
  }
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (address.ss_family == AF_INET) {
    const auto& v4 = reinterpret_cast<const sockaddr_in&>(address);
    ::inet_ntop(AF_INET, &v4.sin_addr, text.data(), text.size());
    return std::string(text.data()).append(":").append(std::to_string(ntohs(v4.sin_port)));
  }
  if (address.ss_family == AF_INET6) {
    const auto& v6 = reinterpret_cast<const sockaddr_in6&>(address);
    ::inet_ntop(AF_INET6, &v6.sin6_addr, text.data(), text.size());
    return std::string("[")
        .append(text.data())
        .append("]:")
        .append(std::to_string(ntohs(v6.sin6_port)));
  }
  ucred credentials{};
  length = sizeof credentials;
  if (::getsockopt(descriptor, SOL_SOCKET, SO_PEERCRED, &credentials, &length) == 0) {
    return std::string("process ").append(std::to_string(credentials.pid));
  }
  return "an unknown peer";
}

}  // namespace

PeerGuard::PeerGuard(zmq::context_t& context, zmq::socket_t& socket, const PeerBounds& bounds,
                     std::string what)
    : bounds_(bounds),
      what_(std::move(what)),
      monitor_(context, socket, ZMQ_EVENT_ACCEPTED | ZMQ_EVENT_DISCONNECTED) {}

void PeerGuard::tend(Time now) {
  while (const auto told = monitor_.next()) {
    const int descriptor = static_cast<int>(told->value);
    if (const auto known = peers_.find(descriptor); known != peers_.end()) forget(known);
    if (told->event == ZMQ_EVENT_ACCEPTED) peers_.emplace(descriptor, Peer{now});
  }
  while (peers_.size() > bounds_.max_peers) {
    // The peer that has been silent for longest, if that is long enough; else the newest.
    const auto order = [](const auto& a, const auto& b) {
      return std::pair(a.second.spoke, a.second.since) < std::pair(b.second.spoke, b.second.since);
    };
    auto chosen = std::min_element(peers_.begin(), peers_.end(), order);
    if (chosen->second.spoke || now - chosen->second.since < kSilence) {
      chosen = std::max_element(peers_.begin(), peers_.end(), [](const auto& a, const auto& b) {
        return a.second.since < b.second.since;
      });
    }
    cut(chosen, "more peers than max_peers");
  }
}

void PeerGuard::hear(Peer& peer, std::string_view key) {
  peer.spoke = true;
  if (peer.key == key) return;
  peer.is_key_doubtful = peer.is_key_doubtful || !peer.key.empty();
  peer.key = key;
}

void PeerGuard::hear(int descriptor, std::string_view key) {
  const auto peer = peers_.find(descriptor);
  if (peer != peers_.end()) hear(peer->second, key);
}

void PeerGuard::count_subscription(int descriptor, std::string_view key, bool begins,
                                   std::size_t bytes) {
  const auto peer = peers_.find(descriptor);
  if (peer == peers_.end()) return;  // has left or been cut
  hear(peer->second, key);
  std::size_t& held = peer->second.subscription_bytes;
  if (!begins) {
    const std::size_t freed = std::min(held, bytes + kSubscriptionOverheadBytes);
    held -= freed;
    subscription_bytes_ -= freed;
    return;
  }
  held += bytes + kSubscriptionOverheadBytes;
  subscription_bytes_ += bytes + kSubscriptionOverheadBytes;
  if (held > bounds_.max_subscription_bytes) {
    cut(peer, "more subscriptions than max_subscription_bytes");
  } else if (subscription_bytes_ > kPeersOfSubscriptions * bounds_.max_subscription_bytes) {
    cut(std::max_element(peers_.begin(), peers_.end(),
                         [](const auto& a, const auto& b) {
                           return a.second.subscription_bytes < b.second.subscription_bytes;
                         }),
        "the most of too many subscriptions");
  }
}

void PeerGuard::cut_others_than(const ClientList& clients) {
  const auto is_known = [](const Peer& peer) { return !peer.key.empty() && !peer.is_key_doubtful; };
  for (auto next = peers_.begin(); next != peers_.end();) {
    const auto peer = next++;
    if (!is_known(peer->second)) {
      cut(peer, "keys have been taken off the list, and which key it has is not known yet");
    }
  }
  // After the others: the report names the last one.
  for (auto next = peers_.begin(); next != peers_.end();) {
    const auto peer = next++;
    if (!clients.allows(peer->second.key)) cut(peer, "its key has been taken off the list");
  }
}

// Shuts the connection's descriptor down, because libzmq has no call for it. To libzmq it looks as
// if the peer had left.
void PeerGuard::cut(Peers::iterator peer, const std::string& why) {
  last_cut_ = name_of_peer(peer->first);
  last_cut_.append(": ").append(why);
  (void)::shutdown(peer->first, SHUT_RDWR);
  ++cut_count_;
  ++cut_unreported_;
  forget(peer);
}

void PeerGuard::forget(Peers::iterator peer) {
  subscription_bytes_ -= peer->second.subscription_bytes;
  peers_.erase(peer);
}

std::string PeerGuard::take_report() {
  if (cut_unreported_ == 0) return {};
  const std::uint64_t count = std::exchange(cut_unreported_, 0);
  return std::to_string(count)
      .append(" connections to ")
      .append(what_)
      .append(" cut, the last of ")
      .append(last_cut_);
}

int descriptor_of(zmq::message_t& message) {
  return message.size() == 0 ? -1 : zmq_msg_get(message.handle(), ZMQ_SRCFD);
}

}  // namespace palpate
