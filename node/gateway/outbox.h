// Messages on their way to the plant, each subject in order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "node/gateway/plant/plant.h"
#include "node/gateway/plant/subjects.h"

namespace palpate::gateway {

/// A message of the cell with its destination.
struct Outgoing {
  Addressed to;
  std::string payload;
  std::uint64_t segment = 0;  ///< of the spool that it was read from; 0 = none
  /// Of those that come from no segment: the spool's next_segment() when it came.
  std::uint64_t before_segment = 0;
  std::string topic = {};  ///< of those that come from no segment
};

/// Publishes each message, and repeats it until the plant confirms that it is stored. To keep the
/// order whatever is lost, only one message of a subject is on its way at a time. In addition, a
/// contact of a new object is sent only after all contacts of the group's old object are stored.
class Outbox {
 public:
  enum class End { Stored, StoredBefore, Refused };
  using Ended = std::function<void(const Outgoing&, End)>;

  /// `ended` is called once for each message.
  Outbox(Plant& plant, Ended ended) : plant_(plant), ended_(std::move(ended)) {}
  ~Outbox() { plant_.forget(this); }
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  /// True if the plant accepts messages and memory has room for another one.
  bool has_room(SteadyTime now) const;

  void add(Outgoing message, SteadyTime now);

  /// Sends again what has not been confirmed. Call it several times a second.
  void tend(SteadyTime now);

  /// Sends nothing before `time`. A gateway that starts while another one runs waits this long, so
  /// that what the other one had before it is stored first, in the other one's order.
  void hold_until(SteadyTime time) { held_until_ = time; }

  /// Takes out all messages that are not known to be stored, in the order in which they were added.
  std::vector<Outgoing> take_all();

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
