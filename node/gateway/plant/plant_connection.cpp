#include "node/gateway/plant/plant_connection.h"

#include <stdexcept>
#include <utility>

namespace palpate::gateway {
namespace {

using std::chrono::milliseconds;

// A frozen server or a cut cable is noticed within three of these.
constexpr milliseconds kPingInterval{500};
constexpr int kPingsUnanswered = 2;
// If one server of a cluster dies, connecting to the next takes this long.
constexpr milliseconds kReconnectWait{50};
constexpr milliseconds kConnectTimeout{2000};
// libnats reconnects after a lost connection, but not if there never was one, nor if the server
// refuses our credentials. The latter may be repaired on the server, so we try again, seldom enough
// for the server's log.
constexpr milliseconds kBetweenAttempts{1000};
// Longest time that a server that does not read can block this thread.
constexpr milliseconds kWriteDeadline{500};
// Beyond it messages are dropped, as a socket would. Each place has at most some thousands in
// flight.
constexpr std::size_t kMostArrived = 200'000;

void check(natsStatus status, const std::string& what) {
  if (status != NATS_OK) throw std::runtime_error(what + ": " + natsStatus_GetText(status));
}

/// libnats' error text without the leading position in its source, "(conn.c:1905): ".
std::string complaint_of(const char* text, natsStatus status) {
  std::string_view said = text != nullptr && *text != 0 ? text : natsStatus_GetText(status);
  if (const std::size_t end = said.find("): "); said.starts_with('(') && end != said.npos) {
    said.remove_prefix(end + 3);
  }
  return std::string(said);
}

natsOptions* new_options() {
  natsOptions* options = nullptr;
  check(natsOptions_Create(&options), "libnats");
  return options;
}

}  // namespace

void PlantConnection::State::take(std::uint64_t subscription, natsMsg* message) {
  PlantMessage taken(subscription, message);
  bool first = false;
  {
    const std::lock_guard lock(mutex);
    if (ended) return;
    if (arrived.size() >= kMostArrived) {
      ++dropped;
      return;
    }
    first = arrived.empty();
    arrived.push_back(std::move(taken));
  }
  if (first) bell.ring();
}

void PlantConnection::State::complain(std::string_view text) {
  const std::lock_guard lock(mutex);
  complaint = text;
}

PlantConnection::PlantConnection(const PlantOptions& options)
    : state_(std::make_shared<State>()), options_(new_options(), &natsOptions_Destroy) {
  natsOptions* nats = options_.get();
  std::vector<const char*> urls;
  for (const std::string& url : options.urls) urls.push_back(url.c_str());
  check(natsOptions_SetServers(nats, urls.data(), static_cast<int>(urls.size())), "server's URL");
  check(natsOptions_SetName(nats, options.client_name.c_str()), "name");
  check(natsOptions_SetPingInterval(nats, kPingInterval.count()), "ping");
  check(natsOptions_SetMaxPingsOut(nats, kPingsUnanswered), "ping");
  check(natsOptions_SetTimeout(nats, kConnectTimeout.count()), "timeout");
  check(natsOptions_SetMaxReconnect(nats, -1), "reconnect");
  check(natsOptions_SetReconnectWait(nats, kReconnectWait.count()), "reconnect");
  check(natsOptions_SetReconnectJitter(nats, kReconnectWait.count(), kReconnectWait.count()),
        "reconnect");
  check(natsOptions_SetWriteDeadline(nats, kWriteDeadline.count()), "deadline");
  check(natsOptions_UseGlobalMessageDelivery(nats, true), "delivery");
  if (!options.credentials.empty()) {
    check(natsOptions_SetUserCredentialsFromFiles(nats, options.credentials.c_str(), nullptr),
          options.credentials.c_str());
  }
  if (!options.tls_ca.empty()) {
    check(natsOptions_SetSecure(nats, true), "TLS");
    check(natsOptions_LoadCATrustedCertificates(nats, options.tls_ca.c_str()),
          options.tls_ca.c_str());
  }
  if (!options.tls_certificate.empty()) {
    check(natsOptions_LoadCertificatesChain(nats, options.tls_certificate.c_str(),
                                            options.tls_key.c_str()),
          options.tls_certificate.c_str());
  }
  set_callbacks();
  connect();
}

void PlantConnection::set_callbacks() {
  natsOptions* nats = options_.get();
  State* state = state_.get();
  const auto is_up = [](natsConnection* /*connection*/, void* closure) {
    auto* told = static_cast<State*>(closure);
    ++told->connections;
    told->connected = true;
    told->bell.ring();
  };
  const auto is_down = [](natsConnection* /*connection*/, void* closure) {
    auto* told = static_cast<State*>(closure);
    told->connected = false;
    told->bell.ring();
  };
  const auto is_closed = [](natsConnection* connection, void* closure) {
    auto* told = static_cast<State*>(closure);
    const char* text = nullptr;
    if (natsConnection_GetLastError(connection, &text) != NATS_OK && text != nullptr) {
      told->complain(text);
    }
    told->connected = false;
    told->closed = true;
    told->bell.ring();
  };
  // (Without a handler libnats prints to standard error.)
  const auto complains = [](natsConnection* connection, natsSubscription* /*subscription*/,
                            natsStatus status, void* closure) {
    const char* text = nullptr;
    natsConnection_GetLastError(connection, &text);
    static_cast<State*>(closure)->complain(
        text != nullptr && *text != 0 ? text : natsStatus_GetText(status));
  };
  check(natsOptions_SetReconnectedCB(nats, is_up, state), "callback");
  check(natsOptions_SetDisconnectedCB(nats, is_down, state), "callback");
  check(natsOptions_SetClosedCB(nats, is_closed, state), "callback");
  check(natsOptions_SetErrorHandler(nats, complains, state), "callback");
}

/// Connects on another thread, because a server that does not answer blocks the call for a while.
void PlantConnection::connect() {
  state_->closed = false;
  state_->connected = true;  // until libnats reports otherwise for this connection
  attempt_ = std::async(std::launch::async, [options = options_.get(), state = state_] {
    Attempt attempt;
    attempt.status = natsConnection_Connect(&attempt.connection, options);
    if (attempt.status != NATS_OK) {
      natsStatus status = attempt.status;
      attempt.complaint =
          complaint_of(nats_GetLastError(&status), attempt.status);  // of this thread
    }
    state->bell.ring();
    return attempt;
  });
}

PlantConnection::~PlantConnection() {
  if (attempt_.valid()) connection_ = attempt_.get().connection;
  drop();
  {
    // libnats frees messages, which it cannot do after it is closed.
    const std::lock_guard lock(state_->mutex);
    state_->ended = true;
    state_->arrived.clear();
  }
  // libnats' threads may be in a callback; they must end before the objects that they use.
  nats_CloseAndWait(kConnectTimeout.count());
}

/// Makes the first connection, and a new one when libnats has given up.
void PlantConnection::renew(SteadyTime now) {
  if (!attempt_.valid()) {
    if ((connection_ == nullptr || state_->closed) && now >= next_attempt_) {
      drop();
      connect();
    }
    return;
  }
  if (attempt_.wait_for(milliseconds(0)) != std::future_status::ready) return;
  Attempt attempt = attempt_.get();
  next_attempt_ = now + kBetweenAttempts;
  if (attempt.status == NATS_INVALID_ARG || attempt.status == NATS_ADDRESS_MISSING) {
    throw std::runtime_error("the plant's address: " + attempt.complaint);
  }
  if (attempt.status != NATS_OK) return state_->complain(attempt.complaint);
  connection_ = attempt.connection;
  for (auto& [id, subscription] : subscriptions_) listen(id, subscription);
  ++state_->connections;
}

void PlantConnection::drop() {
  for (auto& [id, subscription] : subscriptions_) {
    natsSubscription_Destroy(std::exchange(subscription.nats, nullptr));
  }
  natsConnection_Close(connection_);
  natsConnection_Destroy(std::exchange(connection_, nullptr));
}

std::string PlantConnection::take_complaint() {
  const std::lock_guard lock(state_->mutex);
  return std::exchange(state_->complaint, {});
}

void PlantConnection::serve(SteadyTime now) {
  state_->bell.hear();
  renew(now);
  std::vector<PlantMessage> arrived;
  {
    const std::lock_guard lock(state_->mutex);
    arrived.swap(state_->arrived);
  }
  for (const PlantMessage& message : arrived) {
    // A listener may end its own subscription or another one.
    const auto found = subscriptions_.find(message.subscription());
    if (found == subscriptions_.end()) continue;
    const Listener listener = found->second.listener;
    listener(message);
  }
}

bool PlantConnection::publish(const std::string& subject, std::string_view payload,
                              const char* reply, const Headers& headers) {
  if (!is_connected()) return false;
  natsMsg* message = nullptr;
  if (natsMsg_Create(&message, subject.c_str(), reply, payload.data(),
                     static_cast<int>(payload.size())) != NATS_OK) {
    return false;
  }
  const std::unique_ptr<natsMsg, void (*)(natsMsg*)> owned(message, &natsMsg_Destroy);
  for (const auto& [key, value] : headers) {
    if (natsMsgHeader_Set(message, key.c_str(), value.c_str()) != NATS_OK) return false;
  }
  return natsConnection_PublishMsg(connection_, message) == NATS_OK;
}

std::uint64_t PlantConnection::subscribe(const std::string& subject, Listener listener) {
  const std::uint64_t id = ++last_id_;
  Subscription& made = subscriptions_[id];
  made = {subject, std::move(listener), nullptr};
  listen(id, made);
  return id;
}

void PlantConnection::listen(std::uint64_t id, Subscription& subscription) {
  if (connection_ == nullptr) return;  // renew() will
  const auto take = [](natsConnection* /*connection*/, natsSubscription* /*subscription*/,
                       natsMsg* message, void* closure) {
    const Tap* tap = static_cast<Tap*>(closure);
    tap->state->take(tap->id, message);
  };
  auto tap = std::make_unique<Tap>(Tap{state_, id});
  if (natsConnection_Subscribe(&subscription.nats, connection_, subscription.subject.c_str(), take,
                               tap.get()) != NATS_OK) {
    return;  // it is closed: renew() will
  }
  const auto end = [](void* closure) { delete static_cast<Tap*>(closure); };
  natsSubscription_SetOnCompleteCB(subscription.nats, end, tap.release());
}

void PlantConnection::unsubscribe(std::uint64_t id) {
  const auto found = subscriptions_.find(id);
  if (found == subscriptions_.end()) return;
  natsSubscription_Destroy(found->second.nats);  // unsubscribes
  subscriptions_.erase(found);
}

}  // namespace palpate::gateway
