// Decodes the messages that a recognizer publishes. Needs no network.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "node/intake/heard_topics.h"
#include "node/intake/sequence_tracker.h"
#include "node/process/clock.h"
#include "palpate/v1/contact.pb.h"
#include "palpate/v1/local_estimate.pb.h"
#include "palpate/v1/node_status.pb.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate::client {

/// What one receive returned: at most one pointer is set, valid until the next call; none is set
/// after a timeout. The source of a contact or status is the topic's where its sender left it
/// empty.
struct ReceivedResult {
  const v1::Recognition* recognition = nullptr;
  const v1::LocalEstimate* estimate = nullptr;
  const v1::NodeStatus* status = nullptr;
  const v1::ContactBatch* contact = nullptr;

  explicit operator bool() const {
    return recognition != nullptr || estimate != nullptr || status != nullptr || contact != nullptr;
  }
};

struct SubscriberCounters {
  std::uint64_t received = 0;    ///< messages returned
  std::uint64_t duplicates = 0;  ///< dropped: repeated latest values, or from before a restart
  std::uint64_t gaps = 0;        ///< gaps in seq
  std::uint64_t missing = 0;     ///< messages missing in the gaps
  std::uint64_t restarts = 0;    ///< of the recognizer, counted per topic
  std::uint64_t malformed = 0;   ///< not of this contract
  std::uint64_t over_bound = 0;  ///< on topics beyond most_topics, while all of these are heard
};

/// Returns each message once, in order, and keeps the latest recognition of every group. Accepts
/// any bytes: they are decoded or counted as malformed.
class ResultDecoder {
 public:
  explicit ResultDecoder(std::size_t most_topics) : feeds_(most_topics, kIdle) {}

  /// Returns the message if it is new, else nothing.
  ReceivedResult take(std::string_view topic, std::string_view payload,
                      SteadyTime now = now_steady());
  /// Counts a message that does not have two frames.
  void count_malformed() { ++counters_.malformed; }

  /// nullptr if none has come.
  const v1::Recognition* latest(std::string_view group) const;
  std::vector<std::string> groups() const;
  const SubscriberCounters& counters() const { return counters_; }

 private:
  // One topic. The last recognition is kept for latest().
  struct Feed {
    SequenceTracker sequence;
    v1::Recognition recognition;
  };

  // A topic that is silent for longer makes room for another one.
  static constexpr std::chrono::seconds kIdle{10};

  template <typename Message>
  Feed* take_fresh(const Message& message, std::string_view topic, SteadyTime now);

  HeardTopics<Feed> feeds_;
  v1::Recognition recognition_;
  v1::LocalEstimate estimate_;
  v1::NodeStatus status_;
  v1::ContactBatch contact_;
  SubscriberCounters counters_;
};

}  // namespace palpate::client
