#include "node/gateway/plant/plant.h"

#include <utility>
#include <vector>

namespace palpate::gateway {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kApiTimeout{3000};
// Storing takes about a millisecond; a stream without a leader does not answer.
constexpr milliseconds kStoreTimeout{1000};
constexpr milliseconds kExpiryPeriod{20};
// The server's error codes JSStreamWrongLastSequenceErrF and JSStreamMessageExceedsMaximumErr.
constexpr int kWrongLastSequence = 10071;
constexpr int kMessageTooLong = 10054;

std::string new_inbox() {
  natsInbox* inbox = nullptr;
  if (natsInbox_Create(&inbox) != NATS_OK) throw std::bad_alloc();
  std::string text = inbox;
  natsInbox_Destroy(inbox);
  return text;
}

}  // namespace

Plant::Plant(const PlantOptions& options) : connection_(options), inbox_(new_inbox()) {
  connection_.subscribe(inbox_ + ".*", [this](const PlantMessage& message) { answer(message); });
}

void Plant::serve(SteadyTime now) {
  connection_.serve(now);
  expire(now);
}

void Plant::request(const void* owner, const std::string& subject, std::string_view payload,
                    const Headers& headers, milliseconds timeout, Handler handler) {
  const std::uint64_t id = ++last_id_;
  const std::string reply = inbox_ + "." + std::to_string(id);
  // A request that could not be sent times out at once, in serve(): the caller does not expect its
  // handler to be called here.
  const bool sent = connection_.publish(subject, payload, reply.c_str(), headers);
  const SteadyTime now = now_steady();
  requests_[id] = {owner, sent ? now + timeout : now, connection_.connection_count(),
                   std::move(handler)};
  if (!sent) {
    next_expiry_ = now;
    connection_.wake();
  }
}

void Plant::store(const void* owner, const std::string& subject, std::string_view payload,
                  const Headers& headers, std::function<void(const Stored&)> handler) {
  request(owner, subject, payload, headers, kStoreTimeout,
          [handler = std::move(handler)](const PlantMessage* message) {
            Stored stored;
            // "503": no stream has that subject at present, because it has no leader or does not
            // exist.
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
  const auto found = requests_.find(whole_number(text).value_or(0));
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
    if (now >= request.deadline || request.connection != connection_.connection_count())
      over.push_back(id);
  }
  for (const std::uint64_t id : over) {
    const auto found = requests_.find(id);
    if (found == requests_.end()) continue;  // another handler has forgotten it
    const Handler handler = std::move(found->second.handler);
    requests_.erase(found);
    handler(nullptr);
  }
}

void Plant::forget(const void* owner) {
  std::erase_if(requests_, [&](const auto& request) { return request.second.owner == owner; });
}

std::string Plant::private_subject() { return inbox_ + "d." + std::to_string(++last_id_); }

}  // namespace palpate::gateway
