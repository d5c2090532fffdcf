// What a gateway asks of the plant's engine, over its connection: requests and their answers.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <unordered_map>

#include "node/gateway/plant_connection.h"

namespace palpate::gateway {

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

/// Belongs to one thread.
class Plant {
 public:
  /// nullptr: no answer within the time, or the connection was lost meanwhile.
  using Handler = std::function<void(const PlantMessage*)>;

  /// Throws as PlantConnection does.
  explicit Plant(const PlantOptions& options);

  PlantConnection& connection() { return connection_; }
  bool is_connected() const { return connection_.is_connected(); }

  /// Calls the handlers and listeners of what has come, and of requests whose time is over.
  void serve(SteadyTime now);

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

  /// A subject on which nobody else is heard.
  std::string private_subject();

 private:
  struct Request {
    const void* owner = nullptr;
    SteadyTime deadline;
    std::uint64_t connection = 0;
    Handler handler;
  };

  void answer(const PlantMessage& message);
  void expire(SteadyTime now);

  PlantConnection connection_;
  std::string inbox_;
  std::uint64_t last_id_ = 0;
  std::unordered_map<std::uint64_t, Request> requests_;
  SteadyTime next_expiry_;
};

}  // namespace palpate::gateway
