// The connection to the plant's NATS server. libnats uses threads of its own; their messages are
// collected and handled on one thread.
#pragma once

#include <nats/nats.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "node/gateway/plant/plant_message.h"
#include "node/process/bell.h"
#include "node/process/clock.h"

namespace palpate::gateway {

struct PlantOptions {
  std::vector<std::string> urls{
      "nats://127.0.0.1:4222"};  ///< of one server, or of several servers of a cluster
  std::string client_name = "palpate-gateway";
  // Files in NATS' own formats; empty = none.
  std::string credentials;  ///< a user's .creds
  std::string tls_ca;
  std::string tls_certificate;
  std::string tls_key;
};

/// Not thread-safe, except where stated.
class PlantConnection {
 public:
  using Listener = std::function<void(const PlantMessage&)>;

  /// Starts to connect. Keeps trying while no server is there yet or the server refuses. Throws
  /// std::runtime_error if a file cannot be read.
  explicit PlantConnection(const PlantOptions& options);
  ~PlantConnection();
  PlantConnection(const PlantConnection&) = delete;
  PlantConnection& operator=(const PlantConnection&) = delete;

  bool is_connected() const { return connection_ != nullptr && state_->connected.load(); }
  /// Number of connections made so far. When it changes, messages on their way may have been lost.
  std::uint64_t connection_count() const { return state_->connections.load(); }
  /// The last error of the server or of libnats; empty if there was none since the last call.
  std::string take_complaint();

  /// To be polled for input; then call serve().
  int fd() const { return state_->bell.fd(); }
  void wake() const { state_->bell.ring(); }
  /// Calls the listeners of what has arrived. Throws std::runtime_error if an address is malformed.
  void serve(SteadyTime now);

  /// False if there is no connection, or libnats does not accept the message.
  bool publish(const std::string& subject, std::string_view payload, const char* reply = nullptr,
               const Headers& headers = {});

  /// Receives a subject until unsubscribe(), also over later connections.
  std::uint64_t subscribe(const std::string& subject, Listener listener);
  void unsubscribe(std::uint64_t subscription);

  /// Messages dropped because serve() was not called for long.
  std::uint64_t dropped() const { return state_->dropped.load(); }

 private:
  // State shared with libnats' threads.
  struct State {
    std::atomic<bool> connected{false};
    std::atomic<bool> closed{false};
    std::atomic<std::uint64_t> connections{0};
    std::atomic<std::uint64_t> dropped{0};
    Bell bell{Bell::Hearing::AtOnce};
    std::mutex mutex;
    bool ended = false;
    std::vector<PlantMessage> arrived;
    std::string complaint;

    void take(std::uint64_t subscription, natsMsg* message);
    void complain(std::string_view text);
  };

  // Passed to libnats' thread with a subscription, which it may use for longer than we do.
  struct Tap {
    std::shared_ptr<State> state;
    std::uint64_t id = 0;
  };

  struct Subscription {
    std::string subject;
    Listener listener;
    natsSubscription* nats = nullptr;  // of the present connection
  };

  struct Attempt {
    natsStatus status = NATS_OK;
    natsConnection* connection = nullptr;
    std::string complaint;
  };

  void set_callbacks();
  void connect();
  void listen(std::uint64_t id, Subscription& subscription);
  void renew(SteadyTime now);
  void drop();

  std::shared_ptr<State> state_;
  std::unique_ptr<natsOptions, void (*)(natsOptions*)> options_;
  std::future<Attempt> attempt_;
  natsConnection* connection_ = nullptr;
  std::uint64_t last_id_ = 0;
  std::map<std::uint64_t, Subscription> subscriptions_;
  SteadyTime next_attempt_;
};

}  // namespace palpate::gateway
