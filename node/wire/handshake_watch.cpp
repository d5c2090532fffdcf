#include "node/wire/handshake_watch.h"

namespace palpate {
namespace {

constexpr char kDisagreeOnCurve[] =
    "and we do not agree on CURVE: one of us has keys and the other none, or the server key that "
    "we were "
    "given is not its own";

std::string text_of(const SocketEvent& told) {
  if (told.event == ZMQ_EVENT_HANDSHAKE_FAILED_AUTH) {
    return "refuses our key: it is not on its list of clients (--allow-clients)";
  }
  if (told.value == ZMQ_PROTOCOL_ERROR_ZMTP_MECHANISM_MISMATCH) {
    return kDisagreeOnCurve;
  }
  return "does not speak as a recognizer does (ZMTP)";
}

}  // namespace

// Subscribes to a few events per connection only, so that nothing accumulates if nobody reads them.
HandshakeWatch::HandshakeWatch(zmq::context_t& context, zmq::socket_t& socket)
    : monitor_(context, socket,
               ZMQ_EVENT_HANDSHAKE_FAILED_AUTH | ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL |
                   ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL | ZMQ_EVENT_HANDSHAKE_SUCCEEDED |
                   ZMQ_EVENT_DISCONNECTED) {}

const std::string& HandshakeWatch::refusal() {
  // A listener that starts or ends at that moment closes one or two.
  constexpr int kClosedInARow = 8;
  while (const auto told = monitor_.next()) {
    if (told->event == ZMQ_EVENT_HANDSHAKE_SUCCEEDED) {
      closed_in_a_row_ = 0;
      is_gone_ = false;
      was_there_ = true;
    } else if (told->event == ZMQ_EVENT_DISCONNECTED) {
      departures_ += was_there_ && !is_gone_ ? 1 : 0;
      is_gone_ = was_there_;
    } else if (told->event != ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL) {
      refusal_ = text_of(*told);
    } else if (++closed_in_a_row_ == kClosedInARow) {
      refusal_ = std::string(kDisagreeOnCurve) + "; or it takes no more peers";
    }
  }
  return refusal_;
}

}  // namespace palpate
