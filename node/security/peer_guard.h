// Limits the number of peers of a bound socket and the size of their subscriptions.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <zmq.hpp>

#include "node/security/zap_handler.h"
#include "node/wire/socket_monitor.h"

namespace palpate {

struct PeerBounds {
  std::size_t max_peers = 256;  ///< of each socket
  /// Of one peer; all peers together may have kPeersOfSubscriptions times as much. libzmq uses
  /// about 32 bytes of memory for each byte. [bytes]
  std::size_t max_subscription_bytes = 65536;
};

/// libzmq limits neither. This class watches the connections of a socket by its events and cuts
/// those beyond the limits; they are counted and named. Owned by the socket's thread; must be
/// destroyed before the socket.
class PeerGuard {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::size_t kPeersOfSubscriptions = 16;
  /// Added to the length of each subscription, for libzmq's nodes.
  static constexpr std::size_t kSubscriptionOverheadBytes = 32;
  /// A peer silent for this long may be replaced by another.
  static constexpr std::chrono::seconds kSilence{10};

  /// `what`: name of the socket in logs. Throws zmq::error_t if the monitor cannot be created.
  PeerGuard(zmq::context_t& context, zmq::socket_t& socket, const PeerBounds& bounds,
            std::string what);

  /// Reads the events and cuts peers beyond the limit.
  void tend(Time now);

  /// To be polled for input; then call tend().
  zmq::socket_t& events() { return monitor_.events(); }

  /// The peer with that descriptor (descriptor_of) has sent something; `key`: its own (key_of).
  void hear(int descriptor, std::string_view key);

  /// The peer has begun or ended a subscription of so many bytes. Cuts peers beyond the limit.
  void count_subscription(int descriptor, std::string_view key, bool begins, std::size_t bytes);

  /// Cuts the connections whose key is not on the list, and those whose key is not known: libzmq
  /// tells it with a message, so that of a peer that has sent none is not. Of these, clients that
  /// are allowed are back at once.
  void cut_others_than(const ClientList& clients);

  std::uint64_t cut_count() const { return cut_count_; }

  /// Describes the cuts since the last call, for the log; empty if there are none.
  std::string take_report();

 private:
  struct Peer {
    Time since;
    bool spoke = false;
    std::size_t subscription_bytes = 0;
    std::string key = {};  ///< empty = not known
    /// A descriptor is used again, and what its last owner sent may be read after the new one has
    /// come: where two keys have been heard of, neither is believed.
    bool is_key_doubtful = false;
  };
  using Peers = std::map<int, Peer>;

  static void hear(Peer& peer, std::string_view key);
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

/// Descriptor of the connection on which a message arrived; -1 if there is none.
int descriptor_of(zmq::message_t& message);

}  // namespace palpate
