// Receives the contacts of a place from the plant, in the stream's order and without gaps, and
// acknowledges those that are done.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>

#include "node/gateway/plant/plant.h"
#include "node/gateway/plant/subjects.h"

namespace palpate::gateway {

class ContactConsumer {
 public:
  struct Events {
    std::function<void(const PlantMessage& contact, std::uint64_t stream_seq)> contact;
    /// The previous consumer is gone, or another one that is behind it has its name: what is known
    /// of contacts by their numbers may be of another stream's.
    std::function<void()> anew;
    /// No further contacts arrive until forget() and begin().
    std::function<void(const std::string& why)> failed;
  };

  ContactConsumer(Plant& plant, PlaceName place, Events events);

  /// Starts at the first contact that the previous consumer has not acknowledged.
  void begin();
  void forget();

  /// The contact has its answer, or will never have one.
  void done(std::uint64_t stream_seq);
  /// Tells the plant up to which contact all are done.
  void acknowledge();
  /// Call it often. Acknowledges, checks the consumer if the plant has been silent for long, and
  /// says so if contacts of the cell are in no partition.
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
  void look_for_unmapped();

  Plant& plant_;
  PlaceName place_;
  Events events_;
  std::string name_;  // of the consumer on the plant

  std::uint64_t subscription_ = 0;
  std::string deliver_subject_;
  std::uint64_t consumer_seq_ = 0;  // of the last message delivered, counted by the consumer
  std::uint64_t stream_seq_ = 0;    // the same, counted by the stream
  SteadyTime heard_;
  SteadyTime next_look_;  // for contacts in no partition
  bool is_unmapped_told_ = false;
  std::uint64_t floor_ = 0;          // of the previous consumer, when this one began
  std::deque<Delivered> delivered_;  // not acknowledged, in the stream's order
  std::string ack_reply_;            // of the last contact that may be acknowledged
};

}  // namespace palpate::gateway
