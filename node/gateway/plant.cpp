#include "node/gateway/plant.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <stdexcept>

namespace palpate::gateway {
namespace {

using std::chrono::milliseconds;

// A server that is frozen, or a cable that is cut, is noticed within three of these.
constexpr milliseconds kPingInterval{500};
constexpr int kPingsUnanswered = 2;
// One server of a cluster that dies costs a connection to the next.
constexpr milliseconds kReconnectWait{50};
constexpr milliseconds kConnectTimeout{2000};
// What may hold this thread where a server reads no more.
constexpr milliseconds kWriteDeadline{500};
// Beyond it messages are dropped, as a socket would: each place has at most some thousands under
// way.
constexpr std::size_t kMostArrived = 200'000;
constexpr milliseconds kApiTimeout{3000};
// Stored within a millisecond or so; a stream that looks for a leader says nothing.
constexpr milliseconds kStoreTimeout{1000};
constexpr milliseconds kExpiryPeriod{20};
// The engine's numbers of errors (JSStreamWrongLastSequenceErrF, JSStreamMessageExceedsMaximumErr).
constexpr int kWrongLastSequence = 10071;
constexpr int kMessageTooLong = 10054;

void check(natsStatus status, const char* what) {
  if (status != NATS_OK) {
    throw std::runtime_error(std::string(what) + ": " + natsStatus_GetText(status));
  }
}

std::string_view or_empty(const char* text) { return text == nullptr ? std::string_view() : text; }

}  // namespace

std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string_view PlantMessage::reply() const { return or_empty(natsMsg_GetReply(message_.get())); }

std::string_view PlantMessage::payload() const {
  return {natsMsg_GetData(message_.get()),
          static_cast<std::size_t>(natsMsg_GetDataLength(message_.get()))};
}

std::string_view PlantMessage::header(const char* name) const {
  const char** values = nullptr;
  int count = 0;
  if (natsMsgHeader_Values(message_.get(), name, &values, &count) != NATS_OK) return {};
  const std::string_view last = count > 0 ? or_empty(values[count - 1]) : std::string_view();
  std::free(static_cast<void*>(values));  // the array; the texts are the message's
  return last;
}

std::uint64_t PlantMessage::number(const char* name) const {
  return whole_number(header(name)).value_or(0);
}

void Plant::State::take(std::uint64_t subscription, natsMsg* message) {
  PlantMessage taken(subscription, message);
  bool first = false;
  {
    const std::lock_guard lock(mutex);
    if (arrived.size() >= kMostArrived) {
      ++dropped;
      return;
    }
    first = arrived.empty();
    arrived.push_back(std::move(taken));
  }
  if (first) wake();
}

void Plant::State::wake() const {
  const std::uint64_t one = 1;
  (void)!::write(wake_fd, &one, sizeof one);
}

Plant::Plant(const PlantOptions& options) : state_(std::make_shared<State>()) {
  state_->wake_fd = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  natsOptions* nats = nullptr;
  check(natsOptions_Create(&nats), "libnats");
  const std::unique_ptr<natsOptions, void (*)(natsOptions*)> owned(nats, &natsOptions_Destroy);
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
  const auto is_up = [](natsConnection* /*connection*/, void* closure) {
    auto* state = static_cast<State*>(closure);
    ++state->connections;
    state->connected = true;
    state->wake();
  };
  const auto is_down = [](natsConnection* /*connection*/, void* closure) {
    auto* state = static_cast<State*>(closure);
    state->connected = false;
    state->wake();
  };
  check(natsOptions_SetRetryOnFailedConnect(nats, true, is_up, state_.get()), "retry");
  check(natsOptions_SetReconnectedCB(nats, is_up, state_.get()), "callback");
  check(natsOptions_SetDisconnectedCB(nats, is_down, state_.get()), "callback");
  // Without a handler libnats prints to standard error.
  check(natsOptions_SetErrorHandler(
            nats, [](natsConnection*, natsSubscription*, natsStatus, void*) {}, nullptr),
        "callback");
  const natsStatus status = natsConnection_Connect(&connection_, nats);
  if (status == NATS_OK) {
    is_up(connection_, state_.get());
  } else if (status != NATS_NOT_YET_CONNECTED) {
    check(status, "the plant's server");
  }
  natsInbox* inbox = nullptr;
  check(natsInbox_Create(&inbox), "inbox");
  inbox_ = inbox;
  natsInbox_Destroy(inbox);
  if (subscribe(inbox_ + ".*", [this](const PlantMessage& message) { answer(message); }) == 0) {
    throw std::runtime_error("the plant's server: no subscription");
  }
}

Plant::~Plant() {
  while (!subscriptions_.empty()) unsubscribe(subscriptions_.begin()->first);
  natsConnection_Close(connection_);
  natsConnection_Destroy(connection_);
  // libnats' threads may be in a callback: they end before what they touch.
  nats_CloseAndWait(kConnectTimeout.count());
  ::close(state_->wake_fd);
}

void Plant::serve(SteadyTime now) {
  std::uint64_t count = 0;
  (void)!::read(state_->wake_fd, &count, sizeof count);
  std::vector<PlantMessage> arrived;
  {
    const std::lock_guard lock(state_->mutex);
    arrived.swap(state_->arrived);
  }
  for (const PlantMessage& message : arrived) {
    // A listener may end its own subscription, or another's.
    const auto found = subscriptions_.find(message.subscription());
    if (found == subscriptions_.end()) continue;
    const Listener listener = found->second.listener;
    listener(message);
  }
  expire(now);
}

bool Plant::publish(const std::string& subject, std::string_view payload, const char* reply,
                    const Headers& headers) {
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

void Plant::request(const void* owner, const std::string& subject, std::string_view payload,
                    const Headers& headers, milliseconds timeout, Handler handler) {
  const std::uint64_t id = ++last_id_;
  const std::string reply = inbox_ + "." + std::to_string(id);
  // One that could not be sent is over at once: serve() says so, as its caller expects no call yet.
  const bool sent = publish(subject, payload, reply.c_str(), headers);
  const SteadyTime now = std::chrono::steady_clock::now();
  requests_[id] = {owner, sent ? now + timeout : now, connection_count(), std::move(handler)};
  if (!sent) {
    next_expiry_ = now;
    state_->wake();
  }
}

void Plant::store(const void* owner, const std::string& subject, std::string_view payload,
                  const Headers& headers, std::function<void(const Stored&)> handler) {
  request(owner, subject, payload, headers, kStoreTimeout,
          [handler = std::move(handler)](const PlantMessage* message) {
            Stored stored;
            // "503": no stream has that subject at present, for want of a leader or of itself.
            if (message == nullptr || !message->status().empty()) return handler(stored);
            const auto answer = nlohmann::json::parse(message->payload(), nullptr, false);
            if (!answer.is_object()) return handler(stored);
            if (const auto error = answer.find("error"); error != answer.end()) {
              const int number = error->is_object() ? error->value("err_code", 0) : 0;
              if (number == kWrongLastSequence) stored.verdict = Stored::Verdict::NotTheLast;
              if (number == kMessageTooLong) stored.verdict = Stored::Verdict::TooLong;
              return handler(stored);
            }
            stored.seq = answer.value("seq", std::uint64_t{0});
            stored.verdict =
                answer.value("duplicate", false) ? Stored::Verdict::Before : Stored::Verdict::Yes;
            handler(stored);
          });
}

void Plant::api(const void* owner, const std::string& subject, const nlohmann::json& body,
                std::function<void(const nlohmann::json*)> handler) {
  const std::string text = body.is_null() ? std::string() : body.dump();
  request(owner, "$JS.API." + subject, text, {}, kApiTimeout,
          [handler = std::move(handler)](const PlantMessage* message) {
            if (message == nullptr || !message->status().empty()) return handler(nullptr);
            const auto parsed = nlohmann::json::parse(message->payload(), nullptr, false);
            handler(parsed.is_object() ? &parsed : nullptr);
          });
}

void Plant::answer(const PlantMessage& message) {
  const std::string_view subject = message.subject();
  const std::string_view text = subject.substr(subject.rfind('.') + 1);
  std::uint64_t id = 0;
  std::from_chars(text.data(), text.data() + text.size(), id);
  const auto found = requests_.find(id);
  if (found == requests_.end()) return;
  const Handler handler = std::move(found->second.handler);
  requests_.erase(found);
  handler(&message);
}

void Plant::expire(SteadyTime now) {
  if (now < next_expiry_) return;
  next_expiry_ = now + kExpiryPeriod;
  std::vector<std::uint64_t> over;
  for (const auto& [id, request] : requests_) {
    if (now >= request.deadline || request.connection != connection_count()) over.push_back(id);
  }
  for (const std::uint64_t id : over) {
    const auto found = requests_.find(id);
    if (found == requests_.end()) continue;  // forgotten by another's handler
    const Handler handler = std::move(found->second.handler);
    requests_.erase(found);
    handler(nullptr);
  }
}

void Plant::forget(const void* owner) {
  std::erase_if(requests_, [&](const auto& request) { return request.second.owner == owner; });
}

std::uint64_t Plant::subscribe(const std::string& subject, Listener listener) {
  // What libnats' thread touches is the state, which outlives it: a subscription may end while a
  // message of it is on its way.
  const auto take = [](natsConnection* /*connection*/, natsSubscription* subscription,
                       natsMsg* message, void* closure) {
    const auto id = static_cast<std::uint64_t>(natsSubscription_GetID(subscription));
    static_cast<State*>(closure)->take(id, message);
  };
  Subscription made;
  if (natsConnection_Subscribe(&made.nats, connection_, subject.c_str(), take, state_.get()) !=
      NATS_OK) {
    return 0;
  }
  made.listener = std::move(listener);
  const auto id = static_cast<std::uint64_t>(natsSubscription_GetID(made.nats));
  subscriptions_[id] = std::move(made);
  return id;
}

void Plant::unsubscribe(std::uint64_t id) {
  const auto found = subscriptions_.find(id);
  if (found == subscriptions_.end()) return;
  natsSubscription_Destroy(found->second.nats);  // unsubscribes
  subscriptions_.erase(found);
}

std::string Plant::private_subject() { return inbox_ + "d." + std::to_string(++last_id_); }

}  // namespace palpate::gateway
