// Requests to the plant's NATS server and their answers.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <unordered_map>

#include "node/gateway/plant/plant_connection.h"

namespace palpate::gateway {

/// The server's answer to a message that it was asked to store.
struct Stored {
  enum class Verdict {
    Yes,
    Before,      ///< it already has one with that id
    NotTheLast,  ///< another message came in between (Nats-Expected-Last-Subject-Sequence)
    TooLong,     ///< never stored
    NotNow,      ///< no answer, or no room; not known whether it is stored
  };
  Verdict verdict = Verdict::NotNow;
  std::uint64_t seq = 0;  ///< in its stream
};

/// Not thread-safe.
class Plant {
 public:
  /// Gets nullptr if there was no answer in time or the connection was lost meanwhile.
  using Handler = std::function<void(const PlantMessage*)>;

  /// Throws as PlantConnection does.
  explicit Plant(const PlantOptions& options);

  PlantConnection& connection() { return connection_; }
  bool is_connected() const { return connection_.is_connected(); }

  /// Calls handlers and listeners for what has arrived, and the handlers of requests that have
  /// timed out.
  void serve(SteadyTime now);

  /// Publishes a request. The handler is called once, unless forget(owner) comes first.
  void request(const void* owner, const std::string& subject, std::string_view payload,
               const Headers& headers, std::chrono::milliseconds timeout, Handler handler);
  /// The same with JSON in both directions, for the server's own interface.
  void api(const void* owner, const std::string& subject, const nlohmann::json& body,
           std::function<void(const nlohmann::json*)> handler);
  /// Publishes a message that a stream should store.
  void store(const void* owner, const std::string& subject, std::string_view payload,
             const Headers& headers, std::function<void(const Stored&)> handler);
  /// Drops all requests of this owner; their handlers are not called.
  void forget(const void* owner);

  /// A subject on which only this process is heard.
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
