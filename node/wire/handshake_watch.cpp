#include "node/wire/handshake_watch.h"

#include <atomic>
#include <cstdint>
#include <cstring>

namespace palpate {
namespace {

std::string unique_monitor_address() {
  static std::atomic<std::uint64_t> count{0};
  return "inproc://palpate-handshake-watch-" + std::to_string(count.fetch_add(1));
}

std::string text_of(std::uint16_t event, std::uint32_t value) {
  if (event == ZMQ_EVENT_HANDSHAKE_FAILED_AUTH) {
    return "refuses our key: it is not on its list of clients (--allow-clients)";
  }
  if (value == ZMQ_PROTOCOL_ERROR_ZMTP_MECHANISM_MISMATCH) {
    return "and we do not agree on CURVE: one of us has keys, the other none";
  }
  return "does not speak as a recognizer does (ZMTP)";
}

}  // namespace

HandshakeWatch::HandshakeWatch(zmq::context_t& context, zmq::socket_t& socket)
    : socket_(socket), events_(context, zmq::socket_type::pair) {
  const std::string monitor = unique_monitor_address();
  // Only what libzmq gives up after, once a connection: nothing piles up where nobody asks.
  if (zmq_socket_monitor(socket_.handle(), monitor.c_str(),
                         ZMQ_EVENT_HANDSHAKE_FAILED_AUTH | ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL) !=
      0) {
    throw zmq::error_t();
  }
  events_.set(zmq::sockopt::linger, 0);
  events_.connect(monitor);
}

HandshakeWatch::~HandshakeWatch() { zmq_socket_monitor(socket_.handle(), nullptr, 0); }

const std::string& HandshakeWatch::refusal() {
  // Each event is two frames: number and value, then the address.
  zmq::message_t frame;
  while (zmq_msg_recv(frame.handle(), events_.handle(), ZMQ_DONTWAIT) >= 0) {
    std::uint16_t event = 0;
    std::uint32_t value = 0;
    if (frame.size() >= sizeof event + sizeof value) {
      std::memcpy(&event, frame.data(), sizeof event);
      std::memcpy(&value, frame.data<char>() + sizeof event, sizeof value);
      refusal_ = text_of(event, value);
    }
    while (frame.more() && zmq_msg_recv(frame.handle(), events_.handle(), ZMQ_DONTWAIT) >= 0) {
    }
  }
  return refusal_;
}

}  // namespace palpate
