// The contacts of a place as the plant delivers them: in the stream's order, none left out, and
// which of them need not be delivered again.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>

#include "node/gateway/plant.h"
#include "node/gateway/subjects.h"

namespace palpate::gateway {

class ContactConsumer {
 public:
  struct Events {
    std::function<void(const PlantMessage& contact, std::uint64_t stream_seq)> contact;
    /// Nothing more comes until forget() and begin().
    std::function<void(const std::string& why)> failed;
  };

  ContactConsumer(Plant& plant, PlaceName place, Events events);

  /// From the first contact on that a former consumer has not acknowledged.
  void begin();
  void forget();

  /// A contact is answered, or never will be.
  void done(std::uint64_t stream_seq);
  /// Tells the plant up to where all are done.
  void acknowledge();
  /// Call it often: acknowledges, and asks where the plant has been silent for long.
  void tend(SteadyTime now);

 private:
  struct Delivered {
    std::uint64_t stream_seq = 0;
    std::string reply;
    bool is_done = false;
  };

  void make(std::uint64_t start_seq);
  void take(const PlantMessage& message);
  void check();

  Plant& plant_;
  PlaceName place_;
  Events events_;
  std::string name_;  // by which the plant knows it

  std::uint64_t subscription_ = 0;
  std::string deliver_subject_;
  std::uint64_t consumer_seq_ = 0;  // of the message delivered last, by the consumer's count
  std::uint64_t stream_seq_ = 0;    // by the stream's
  SteadyTime heard_;
  std::deque<Delivered> delivered_;  // not acknowledged, in the stream's order
  std::string ack_reply_;            // of the last of those that may be
};

}  // namespace palpate::gateway
