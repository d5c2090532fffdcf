// The connection to the plant's engine, NATS: libnats has threads of its own, what they bring is
// taken by one.
#pragma once

#include <nats/nats.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "node/process/clock.h"

namespace palpate::gateway {

struct PlantOptions {
  std::vector<std::string> urls{
      "nats://127.0.0.1:4222"};  ///< of one server or several of a cluster
  std::string client_name = "palpate-gateway";
  // The engine's own files; empty = none.
  std::string credentials;  ///< a user's .creds
  std::string tls_ca;
  std::string tls_certificate;
  std::string tls_key;
};

/// A text that is a number and nothing else.
std::optional<std::uint64_t> whole_number(std::string_view text);

/// A message of the plant.
class PlantMessage {
 public:
  /// `subscription`: by which it came; 0 = by none.
  PlantMessage(std::uint64_t subscription, natsMsg* message)
      : subscription_(subscription), message_(message, &natsMsg_Destroy) {}

  std::uint64_t subscription() const { return subscription_; }
  std::string_view subject() const { return natsMsg_GetSubject(message_.get()); }
  /// Empty where it wants no answer.
  std::string_view reply() const;
  std::string_view payload() const;
  /// Empty where it has none of that name. Of several the last: what the engine adds to a message
  /// comes behind what its sender has written.
  std::string_view header(const char* name) const;
  /// A number in a header; 0 where there is none.
  std::uint64_t number(const char* name) const;
  /// The engine's own word in place of a payload, e.g. "404", "503"; empty else.
  std::string_view status() const { return header("Status"); }

 private:
  std::uint64_t subscription_;
  std::unique_ptr<natsMsg, void (*)(natsMsg*)> message_;
};

using Headers = std::vector<std::pair<std::string, std::string>>;

/// What the engine says of a message that it was to store.
struct Stored {
  enum class Verdict {
    Yes,
    Before,      ///< it has one of that id already
    NotTheLast,  ///< another message has come in between (Nats-Expected-Last-Subject-Sequence)
    TooLong,     ///< never
    NotNow,      ///< nobody answered, or no room: whether it is stored is not known
  };
  Verdict verdict = Verdict::NotNow;
  std::uint64_t seq = 0;  ///< in its stream
};

/// Belongs to one thread but for what says otherwise.
class Plant {
 public:
  /// nullptr: no answer within the time, or the connection was lost meanwhile.
  using Handler = std::function<void(const PlantMessage*)>;
  using Listener = std::function<void(const PlantMessage&)>;

  /// Begins to connect, and goes on for ever where nobody is there yet. Throws std::runtime_error
  /// where the options are wrong: a file cannot be read, an address is none.
  explicit Plant(const PlantOptions& options);
  ~Plant();
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;

  bool is_connected() const { return state_->connected.load(); }
  /// Connections made so far: another number means that what was on its way may be lost.
  std::uint64_t connection_count() const { return state_->connections.load(); }

  /// To be polled for input: serve() has something to do.
  int fd() const { return state_->wake_fd; }
  /// Calls the handlers of what has come, and of requests whose time is over.
  void serve(SteadyTime now);

  /// False where there is no connection, or libnats does not take it.
  bool publish(const std::string& subject, std::string_view payload, const char* reply = nullptr,
               const Headers& headers = {});

  /// Publishes with an address for the answer; the handler is called once, unless forget(owner)
  /// comes first.
  void request(const void* owner, const std::string& subject, std::string_view payload,
               const Headers& headers, std::chrono::milliseconds timeout, Handler handler);
  /// The same with JSON both ways, for the engine's own interface.
  void api(const void* owner, const std::string& subject, const nlohmann::json& body,
           std::function<void(const nlohmann::json*)> handler);
  /// Publishes a message that a stream is to store.
  void store(const void* owner, const std::string& subject, std::string_view payload,
             const Headers& headers, std::function<void(const Stored&)> handler);
  /// Its requests are answered no more.
  void forget(const void* owner);

  /// Hears of a subject until unsubscribe(); 0 where it cannot be. Survives reconnections.
  std::uint64_t subscribe(const std::string& subject, Listener listener);
  void unsubscribe(std::uint64_t subscription);

  /// A subject on which nobody else is heard.
  std::string private_subject();

  /// Messages dropped because serve() was not called for long.
  std::uint64_t dropped() const { return state_->dropped.load(); }

 private:
  // What libnats' threads touch.
  struct State {
    std::atomic<bool> connected{false};
    std::atomic<std::uint64_t> connections{0};
    std::atomic<std::uint64_t> dropped{0};
    int wake_fd = -1;
    std::mutex mutex;
    std::vector<PlantMessage> arrived;

    void wake() const;
    void take(std::uint64_t subscription, natsMsg* message);
  };

  struct Subscription {
    natsSubscription* nats = nullptr;
    Listener listener;
  };

  struct Request {
    const void* owner = nullptr;
    SteadyTime deadline;
    std::uint64_t connection = 0;
    Handler handler;
  };

  void answer(const PlantMessage& message);
  void expire(SteadyTime now);

  std::shared_ptr<State> state_;
  natsConnection* connection_ = nullptr;
  std::string inbox_;
  std::uint64_t last_id_ = 0;
  std::map<std::uint64_t, Subscription> subscriptions_;
  std::unordered_map<std::uint64_t, Request> requests_;
  SteadyTime next_expiry_;
};

}  // namespace palpate::gateway
