#include "node/tool/commands/listening_place.h"

#include <vector>

#include "node/process/stop_signals.h"

namespace palpate {
namespace {

// A disk may pause for so many messages. With the longest of them, 640 MB a peer.
constexpr int kMessagesWaiting = 10'000;
// What the recognizer takes by default.
constexpr std::int64_t kMostMessageBytes = 65'536;

}  // namespace

int ListeningPlace::open_as_recognizer(const ListeningFlags& flags) {
  const Result<Endpoint> endpoint = parse_endpoint(flags.endpoint, /*bind_by_default=*/true);
  if (!endpoint) return complain(endpoint.error, kUsage);
  if (endpoint.value->bind && !is_local(*endpoint.value) && flags.curve_secret_key.empty() &&
      !flags.insecure) {
    return complain(flags.endpoint +
                        " is open to the network: give --curve-secret-key and "
                        "--allow-clients, or say --insecure",
                    kUsage);
  }
  const Result<NodeKeys> keys = read_node_keys(flags.curve_secret_key, flags.allow_clients);
  if (!keys) return complain(keys.error, kUsage);
  zap_ = make_zap_handler(context_, *keys.value);
  SocketSettings settings;
  settings.curve_server = keys.value->own;
  settings.max_message_bytes = kMostMessageBytes;
  return open(*endpoint.value, settings);
}

int ListeningPlace::open_as_client(const std::string& endpoint,
                                   const std::optional<CurveClient>& curve) {
  const Result<Endpoint> parsed = parse_endpoint(endpoint, /*bind_by_default=*/false);
  if (!parsed) return complain(parsed.error, kUsage);
  SocketSettings settings;
  settings.curve_client = curve;
  return open(*parsed.value, settings);
}

int ListeningPlace::open(const Endpoint& endpoint, const SocketSettings& settings) {
  SocketSettings patient = settings;
  patient.receive_high_water_mark = kMessagesWaiting;
  socket_ = make_socket(context_, zmq::socket_type::sub, patient);
  socket_->set(zmq::sockopt::subscribe, "");
  if (!zap_) handshakes_.emplace(context_, *socket_);
  if (const std::string error = attach(*socket_, endpoint, &lock_); !error.empty()) {
    return complain(error + (endpoint.bind ? " (is the recognizer running? stop it: this takes its "
                                             "place)"
                                           : ""),
                    kFailed);
  }
  return kDone;
}

void ListeningPlace::listen(int stop_fd, std::optional<std::chrono::steady_clock::time_point> end,
                            const std::function<bool(const TwoFrames&)>& take) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kStep{50};
  constexpr int kMostAtOnce = 1000;
  std::vector<zmq::pollitem_t> items{{socket_->handle(), 0, ZMQ_POLLIN, 0}};
  if (zap_) items.push_back({zap_->socket().handle(), 0, ZMQ_POLLIN, 0});
  if (handshakes_) items.push_back({handshakes_->events().handle(), 0, ZMQ_POLLIN, 0});
  TwoFrames frames;
  bool wants_more = true;
  while (wants_more && !stop_requested(stop_fd) && (!end || Clock::now() < *end)) {
    poll(items, static_cast<int>(kStep.count()));
    if (zap_) zap_->serve();
    if (!refusal().empty()) return;
    const Clock::time_point turn = Clock::now() + kStep;
    drain(*socket_, frames, kMostAtOnce, end ? std::min(*end, turn) : turn,
          [&](const TwoFrames& message) { wants_more = wants_more && take(message); });
  }
}

}  // namespace palpate
