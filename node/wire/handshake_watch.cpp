#include "node/wire/handshake_watch.h"

namespace palpate {
namespace {

std::string text_of(const SocketEvent& told) {
  if (told.event == ZMQ_EVENT_HANDSHAKE_FAILED_AUTH) {
    return "refuses our key: it is not on its list of clients (--allow-clients)";
  }
  if (told.value == ZMQ_PROTOCOL_ERROR_ZMTP_MECHANISM_MISMATCH) {
    return "and we do not agree on CURVE: one of us has keys, the other none";
  }
  return "does not speak as a recognizer does (ZMTP)";
}

}  // namespace

// Only what libzmq gives up after, once a connection: nothing piles up where nobody asks.
HandshakeWatch::HandshakeWatch(zmq::context_t& context, zmq::socket_t& socket)
    : monitor_(context, socket,
               ZMQ_EVENT_HANDSHAKE_FAILED_AUTH | ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL) {}

const std::string& HandshakeWatch::refusal() {
  while (const auto told = monitor_.next()) refusal_ = text_of(*told);
  return refusal_;
}

}  // namespace palpate
