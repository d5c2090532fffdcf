// Bounds on the peers of a bound socket, and on what they subscribe to.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <zmq.hpp>

#include "node/wire/socket_monitor.h"

namespace palpate {

struct PeerBounds {
  std::size_t max_peers = 256;  ///< of each socket
  /// Of one peer; all together may have kPeersOfSubscriptions times as much. libzmq takes about 32
  /// bytes of memory for each byte. [bytes]
  std::size_t max_subscription_bytes = 65536;
};

/// libzmq itself bounds neither. This watches the connections of a socket by its events, and cuts
/// those that are too many or ask for too much; who has been cut is counted and named. Belongs to
/// the socket's thread, and must be destroyed before the socket.
class PeerGuard {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::size_t kPeersOfSubscriptions = 16;
  /// What a subscription counts beside its own bytes, for the nodes that libzmq keeps at its end.
  static constexpr std::size_t kSubscriptionOverheadBytes = 32;
  /// A peer that has said nothing for so long gives way to another.
  static constexpr std::chrono::seconds kSilence{10};

  /// `what`: name of the socket in logs. Throws zmq::error_t where the monitor cannot be made.
  PeerGuard(zmq::context_t& context, zmq::socket_t& socket, const PeerBounds& bounds,
            std::string what);

  /// Takes the events that have come, and cuts who is too many.
  void tend(Time now);

  /// To be polled for input: tend() then.
  zmq::socket_t& events() { return monitor_.events(); }

  /// The peer of that descriptor (descriptor_of) has said something.
  void hear(int descriptor);

  /// It has subscribed to so many bytes, or ended that subscription. Cuts who has too much.
  void count_subscription(int descriptor, bool begins, std::size_t bytes);

  /// Cuts all: who may, comes back at once.
  void cut_all(const std::string& why);

  std::size_t peer_count() const { return peers_.size(); }
  std::uint64_t cut_count() const { return cut_count_; }

  /// What has been cut since the last call, for the log; empty where nothing has.
  std::string take_report();

 private:
  struct Peer {
    Time since;
    bool spoke = false;
    std::size_t subscription_bytes = 0;
  };
  using Peers = std::map<int, Peer>;

  void cut(Peers::iterator peer, const std::string& why);
  void forget(Peers::iterator peer);

  PeerBounds bounds_;
  std::string what_;
  SocketMonitor monitor_;
  Peers peers_;  // by descriptor
  std::size_t subscription_bytes_ = 0;
  std::uint64_t cut_count_ = 0;
  std::uint64_t cut_unreported_ = 0;
  std::string last_cut_;
};

/// Descriptor of the connection that a message came in on; -1 where it came from nobody.
int descriptor_of(zmq::message_t& message);

}  // namespace palpate
