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
constexpr std::size_t kZ85Length = 40;
// The name by which ZMTP passes the user id of the ZAP reply.
constexpr const char* kUserId = "User-Id";

std::string z85_of(std::string_view bytes) {
  std::array<char, kZ85Length + 1> text{};
  if (bytes.size() != kKeyBytes) return {};
  zmq_z85_encode(text.data(), reinterpret_cast<const std::uint8_t*>(bytes.data()), kKeyBytes);
  return text.data();
}

}  // namespace

ClientList::ClientList(const std::vector<AllowedClient>& clients) {
  for (const AllowedClient& client : clients) {
    std::array<std::uint8_t, kKeyBytes> bytes{};
    if (zmq_z85_decode(bytes.data(), client.public_key.c_str()) != nullptr) {
      clients_.emplace(client.public_key, client.probes);
    }
  }
}

Sender ClientList::sender(std::string_view key) const {
  static const ProbeNames kNobody;
  const auto client = clients_.find(key);
  if (client == clients_.end()) return {key, &kNobody};
  return {key, client->second ? &*client->second : nullptr};
}

bool ClientList::allows_all_of(const ClientList& other) const {
  return std::all_of(other.clients_.begin(), other.clients_.end(),
                     [this](const auto& client) { return allows(client.first); });
}

std::array<std::string, 6> zap_reply(std::span<const std::string> frames,
                                     const ClientList& clients) {
  const std::string request_id = frames.size() > 1 ? frames[1] : std::string();
  const bool well_formed = frames.size() == kZapFrames && frames[0] == kZapVersion &&
                           frames[2] == kZapDomain && frames[5] == "CURVE";
  const std::string key = well_formed ? z85_of(frames[6]) : std::string();
  if (!key.empty() && clients.allows(key)) {
    return {std::string(kZapVersion), request_id, "200", "OK", key, ""};
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

std::string_view key_of(const zmq::message_t& frame) {
  const char* key = zmq_msg_gets(frame.handle(), kUserId);
  return key == nullptr ? std::string_view() : std::string_view(key);
}

}  // namespace palpate
