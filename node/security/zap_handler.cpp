#include "node/security/zap_handler.h"

#include <zmq.h>

#include <algorithm>

#include "node/wire/socket.h"

namespace palpate {
namespace {

constexpr const char* kZapAddress = "inproc://zeromq.zap.01";
constexpr std::string_view kZapVersion = "1.0";
constexpr std::size_t kKeyBytes = 32;
constexpr std::size_t kZapFrames = 7;

}  // namespace

ClientList::ClientList(const std::vector<std::string>& public_keys) {
  for (const std::string& key : public_keys) {
    std::array<std::uint8_t, kKeyBytes> bytes{};
    if (zmq_z85_decode(bytes.data(), key.c_str()) != nullptr) {
      keys_.emplace(bytes.begin(), bytes.end());
    }
  }
}

bool ClientList::allows(std::string_view key) const { return keys_.find(key) != keys_.end(); }

bool ClientList::allows_all_of(const ClientList& other) const {
  return std::includes(keys_.begin(), keys_.end(), other.keys_.begin(), other.keys_.end());
}

std::array<std::string, 6> zap_reply(std::span<const std::string> frames,
                                     const ClientList& clients) {
  const std::string request_id = frames.size() > 1 ? frames[1] : std::string();
  const bool well_formed = frames.size() == kZapFrames && frames[0] == kZapVersion &&
                           frames[2] == kZapDomain && frames[5] == "CURVE";
  if (well_formed && clients.allows(frames[6])) {
    return {std::string(kZapVersion), request_id, "200", "OK", "", ""};
  }
  return {std::string(kZapVersion), request_id, "400", "not allowed", "", ""};
}

ZapHandler::ZapHandler(zmq::context_t& context, ClientList clients)
    : clients_(std::move(clients)), socket_(context, zmq::socket_type::rep) {
  socket_.set(zmq::sockopt::linger, 0);
  socket_.bind(kZapAddress);
}

void ZapHandler::serve() {
  zmq::message_t frame;
  while (zmq_msg_recv(frame.handle(), socket_.handle(), ZMQ_DONTWAIT) >= 0) {
    std::vector<std::string> frames{frame.to_string()};
    while (frame.more() && zmq_msg_recv(frame.handle(), socket_.handle(), 0) >= 0) {
      frames.push_back(frame.to_string());
    }
    const std::array<std::string, 6> reply = zap_reply(frames, clients_);
    if (reply[2] != "200") {
      ++denied_count_;
      constexpr std::size_t kAddress = 3;
      last_denied_ = frames.size() > kAddress ? frames[kAddress] : std::string();
    }
    for (std::size_t i = 0; i < reply.size(); ++i) {
      zmq_send(socket_.handle(), reply[i].data(), reply[i].size(),
               i + 1 < reply.size() ? ZMQ_SNDMORE : 0);
    }
  }
}

}  // namespace palpate
