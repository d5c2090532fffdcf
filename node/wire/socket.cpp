#include "node/wire/socket.h"

#include <cerrno>
#include <mutex>
#include <utility>

namespace palpate {
namespace {

// A frozen peer or a cut cable is noticed after one interval and one timeout. Only the publishing
// side sends heartbeats: if a reader's own heartbeat expires while its queue is full (it has not
// read for that long), libzmq 4.3 aborts the process when the queue is emptied ("_input_stopped").
constexpr int kHeartbeatIntervalMs = 200;
constexpr int kHeartbeatTimeoutMs = 600;
// A reader notices a cut cable by TCP keepalive instead: after a second of silence and three
// unanswered probes.
constexpr int kKeepaliveIdleS = 1;
constexpr int kKeepaliveIntervalS = 1;
constexpr int kKeepaliveProbes = 3;
// A peer that connects and does not complete the handshake is dropped after this time.
constexpr int kHandshakeTimeoutMs = 1000;
// Retries after 10 ms, 20 ms, then every 32 to 42 ms: a restarted recognizer is found within 50 ms,
// and a machine that is down costs a few packets per second.
constexpr int kReconnectFirstMs = 10;
constexpr int kReconnectMaxMs = 32;
// Closing waits this long for unsent messages, even for a peer that has stopped reading.
constexpr int kLingerMs = 100;
// ZMQ_ZAP_ENFORCE_DOMAIN: libzmq 4.3 has it, but zmq.h declares it only among the drafts.
constexpr int kZapEnforceDomain = 93;

// Holds locks until the process ends.
class PathLocks {
 public:
  void keep(PathLock lock) {
    const std::lock_guard guard(mutex_);
    locks_.push_back(std::move(lock));
  }

 private:
  std::mutex mutex_;
  std::vector<PathLock> locks_;
};

}  // namespace

zmq::socket_t make_socket(zmq::context_t& context, zmq::socket_type type,
                          const SocketSettings& settings) {
  zmq::socket_t socket(context, type);
  socket.set(zmq::sockopt::linger, kLingerMs);
  socket.set(zmq::sockopt::sndhwm, settings.send_high_water_mark);
  socket.set(zmq::sockopt::rcvhwm, settings.receive_high_water_mark);
  if (type == zmq::socket_type::pub || type == zmq::socket_type::xpub) {
    socket.set(zmq::sockopt::heartbeat_ivl, kHeartbeatIntervalMs);
    socket.set(zmq::sockopt::heartbeat_timeout, kHeartbeatTimeoutMs);
  }
  socket.set(zmq::sockopt::tcp_keepalive, 1);
  socket.set(zmq::sockopt::tcp_keepalive_idle, kKeepaliveIdleS);
  socket.set(zmq::sockopt::tcp_keepalive_intvl, kKeepaliveIntervalS);
  socket.set(zmq::sockopt::tcp_keepalive_cnt, kKeepaliveProbes);
  socket.set(zmq::sockopt::handshake_ivl, kHandshakeTimeoutMs);
  socket.set(zmq::sockopt::reconnect_ivl, kReconnectFirstMs);
  socket.set(zmq::sockopt::reconnect_ivl_max, kReconnectMaxMs);
  socket.set(zmq::sockopt::maxmsgsize, settings.max_message_bytes);
  if (settings.curve_server) {
    socket.set(zmq::sockopt::curve_server, true);
    socket.set(zmq::sockopt::curve_secretkey, settings.curve_server->secret_key);
    // With enforcement libzmq admits no key if there is no ZAP handler; without it, it would admit
    // every key.
    socket.set(zmq::sockopt::zap_domain, kZapDomain);
    const int enforce = 1;
    if (zmq_setsockopt(socket.handle(), kZapEnforceDomain, &enforce, sizeof enforce) != 0) {
      throw zmq::error_t();
    }
  }
  if (settings.curve_client) {
    socket.set(zmq::sockopt::curve_serverkey, settings.curve_client->server_public_key);
    socket.set(zmq::sockopt::curve_publickey, settings.curve_client->keys.public_key);
    socket.set(zmq::sockopt::curve_secretkey, settings.curve_client->keys.secret_key);
  }
  return socket;
}

std::string attach(zmq::socket_t& socket, const Endpoint& endpoint, PathLock* lock) {
  // Otherwise libzmq would silently take the path from the socket that has bound it.
  if (const std::string path = ipc_path(endpoint.address); endpoint.bind && !path.empty()) {
    Result<PathLock> locked = PathLock::acquire(path);
    if (!locked) return "cannot bind to " + endpoint.address + ": " + locked.error;
    static PathLocks kept;
    if (lock != nullptr) {
      *lock = std::move(*locked.value);
    } else {
      kept.keep(std::move(*locked.value));
    }
  }
  // Only if the address is IPv6; otherwise IPv4 addresses would be shown as mapped ones.
  socket.set(zmq::sockopt::ipv6, endpoint.address.find('[') != std::string::npos);
  const int rc = endpoint.bind ? zmq_bind(socket.handle(), endpoint.address.c_str())
                               : zmq_connect(socket.handle(), endpoint.address.c_str());
  if (rc == 0) return {};
  const int error = zmq_errno();
  return "cannot " + std::string(endpoint.bind ? "bind" : "connect") + " to " + endpoint.address +
         ": " + zmq_strerror(error) +
         (error == ENODEV ? " (to bind, name an interface or an address, such as 127.0.0.1)" : "");
}

bool receive_now(zmq::socket_t& socket, TwoFrames& message) {
  message.frame_count = 0;
  message.topic.rebuild();
  message.payload.rebuild();
  zmq::message_t surplus;
  for (bool more = true; more;) {
    zmq::message_t& frame = message.frame_count == 0   ? message.topic
                            : message.frame_count == 1 ? message.payload
                                                       : surplus;
    if (zmq_msg_recv(frame.handle(), socket.handle(), ZMQ_DONTWAIT) < 0) {
      // ZeroMQ delivers all frames of a message or none, so after the first frame only a signal can
      // interrupt.
      if (zmq_errno() == EINTR && message.frame_count > 0) continue;
      return false;
    }
    ++message.frame_count;
    more = frame.more();
  }
  return true;
}

bool forward_now(zmq::socket_t& socket, TwoFrames& message) {
  int rc = 0;
  do {
    rc = zmq_msg_send(message.topic.handle(), socket.handle(), ZMQ_SNDMORE | ZMQ_DONTWAIT);
  } while (rc < 0 && zmq_errno() == EINTR);
  if (rc < 0) return false;
  do {
    rc = zmq_msg_send(message.payload.handle(), socket.handle(), ZMQ_DONTWAIT);
  } while (rc < 0 && zmq_errno() == EINTR);
  return rc >= 0;
}

bool send_now(zmq::socket_t& socket, std::string_view topic, std::string_view payload) {
  int rc = 0;
  do {
    rc = zmq_send(socket.handle(), topic.data(), topic.size(), ZMQ_SNDMORE | ZMQ_DONTWAIT);
  } while (rc < 0 && zmq_errno() == EINTR);
  if (rc < 0) return false;
  do {
    rc = zmq_send(socket.handle(), payload.data(), payload.size(), ZMQ_DONTWAIT);
  } while (rc < 0 && zmq_errno() == EINTR);
  return rc >= 0;
}

void poll(std::vector<zmq::pollitem_t>& items, int timeout_ms) {
  for (zmq::pollitem_t& item : items) item.revents = 0;
  // An interrupted poll may have left revents unset, which looks like a timeout.
  (void)zmq_poll(items.data(), static_cast<int>(items.size()), timeout_ms);
}

}  // namespace palpate
