// What is on its way to the plant, in the order that the plant is to have it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>

#include "node/gateway/plant.h"
#include "node/gateway/subjects.h"

namespace palpate::gateway {

/// A message of the cell with its address.
struct Outgoing {
  Addressed to;
  std::string payload;
  std::uint64_t segment = 0;  ///< of the spool that it comes from; 0 = of none
};

/// Publishes, and again until the plant says that it is stored. Whatever is lost on the way, each
/// subject's messages are stored in their order: one at a time of a subject is on its way. And of a
/// group no contact of another object goes before all of the former object are stored.
class Outbox {
 public:
  enum class End { Stored, StoredBefore, Refused };
  using Ended = std::function<void(const Outgoing&, End)>;

  /// `ended` is told of each message once.
  Outbox(Plant& plant, Ended ended) : plant_(plant), ended_(std::move(ended)) {}
  ~Outbox() { plant_.forget(this); }
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  /// Whether the plant takes messages and memory has room for another.
  bool has_room(SteadyTime now) const;

  void add(Outgoing message, SteadyTime now);

  /// Sends again what has been for nothing. Call it some times a second.
  void tend(SteadyTime now);

  /// Nothing is sent before. A gateway that starts beside another one waits so long: what it has
  /// and the other had before it is then stored, in the other's order.
  void hold_until(SteadyTime time) { held_until_ = time; }

  std::size_t size() const { return size_; }

 private:
  struct Entry {
    Outgoing message;
    std::uint64_t ticket = 0;
    bool is_under_way = false;
  };
  using Lane = std::deque<Entry>;  // of one group of contacts, or of one other subject

  void send(Lane& lane, SteadyTime now);
  void answered(const std::string& lane, std::uint64_t ticket, const Stored& stored);

  Plant& plant_;
  Ended ended_;
  std::map<std::string, Lane, std::less<>> lanes_;
  std::size_t size_ = 0;
  std::size_t bytes_ = 0;
  std::uint64_t last_ticket_ = 0;
  SteadyTime held_until_;
  SteadyTime failed_at_;
  bool is_failing_ = false;
};

}  // namespace palpate::gateway
