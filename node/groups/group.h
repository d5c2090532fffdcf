// A group: the probes that touch one object. Decides which of their messages count, and keeps the
// messages that wait for the recognizer.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "node/groups/group_recognizer.h"
#include "node/intake/contact_queue.h"
#include "node/intake/ingest.h"
#include "node/intake/probe_registry.h"

namespace palpate {

struct GroupOptions {
  std::size_t max_probes_per_group = 16;
  /// A probe that still sends another object's number is accepted after the others have been silent
  /// for this time.
  std::chrono::duration<double> object_takeover{1.0};
  /// After lost messages, the patch is split where the gap exceeds this many sample spacings.
  double gap_break_spacings = 10.0;
  /// Class of all parts; it is fitted without a search. nullopt = search.
  std::optional<CurveClass> given_class = {};
};

/// What has waited in vain.
struct Superseded {
  std::size_t samples = 0;
  std::size_t objects = 0;  ///< of which no sample was recognised
};

/// Owned by the node's thread. Its recognizer runs on a worker's thread and computes one answer at
/// a time. Messages that arrive meanwhile wait and are then answered together: under load there are
/// fewer answers, but none is delayed.
class Group {
 public:
  Group(std::string_view name, const RecognizerOptions& recognizer, const GroupOptions& options)
      : name_(name),
        options_(options),
        recognizer_(std::make_shared<GroupRecognizer>(name, recognizer, options.gap_break_spacings,
                                                      options.given_class)) {}

  /// Whether the message may be accepted; REJECT_REASON_UNSPECIFIED = yes. `probe` is its sender,
  /// or nullptr if not known yet. Changes nothing.
  v1::RejectReason judge(const ContactMessage& message, const Probe* probe, SteadyTime now) const;

  /// Accepts a message that judge() has passed and queues it. If a new object begins, the waiting
  /// messages of the old one are dropped. Returns what was dropped.
  Superseded take(const ContactMessage& message, Continuity continuity, SteadyTime now);

  /// Moves all waiting messages to the recognizer and returns it for run(). Until end_work() it
  /// belongs to the thread that runs it.
  std::shared_ptr<GroupRecognizer> begin_work();

  /// Call it when run() has returned. The answer is valid until the next begin_work().
  GroupRecognizer::Answer& end_work();

  bool is_in_work() const { return in_work_; }

  /// Expected processor time of the next answer; 0 before the first. It is the maximum of the last
  /// time and half of the last expectation: the quick first answers of a new object do not make a
  /// slow group quick. Time spent waiting for a core does not count.
  std::chrono::nanoseconds expected_compute() const { return expected_compute_; }

  bool is_quick() const { return expected_compute_ <= kQuickCompute; }

  /// An answer within this time reaches a planner of 50 Hz in its next period.
  static constexpr std::chrono::milliseconds kQuickCompute{20};

  /// Memory of the messages that wait or are being processed. [bytes]
  std::size_t queued_bytes() const { return waiting_.bytes() + in_work_bytes_; }

  /// What would wait in vain if nothing more were recognised.
  Superseded waiting() const {
    return {waiting_.sample_count(), members_.empty() || was_begun_ ? 0U : 1U};
  }

  /// Whether other probes than this one have touched the present object.
  bool is_touched_by_others_than(std::string_view probe) const;
  /// Whether other probes have touched the present object, and this one has not.
  bool is_touched_only_by_others_than(std::string_view probe) const;

  /// Of the probe's messages in this group, all objects of it, that take_sequence() was called for;
  /// nullptr if there are none.
  const SequenceTracker* sequence_of(std::string_view probe) const;
  SequenceEvent take_sequence(const ContactMessage& message);
  /// Call it for a probe that the node knows no longer, so that the memory of probes is bounded.
  void forget_probe(std::string_view probe);

  const std::string& name() const { return name_; }
  std::uint64_t object() const { return object_; }
  SteadyTime last_taken() const { return last_taken_; }

 private:
  // A probe that has touched the present object.
  struct Member {
    std::string probe;
    SteadyTime last_taken;
  };

  // Of a probe's messages in this group.
  struct Heard {
    SequenceTracker sequence;
    std::uint64_t object = 0;  // of the latest one
  };

  bool is_stale_object(const ContactMessage& message, const Probe* probe, SteadyTime now) const;
  const Member* find_member(std::string_view probe) const;

  std::string name_;
  GroupOptions options_;
  std::shared_ptr<GroupRecognizer> recognizer_;
  ContactQueue waiting_;
  bool in_work_ = false;
  bool was_begun_ = false;  // a recognition of the present object
  std::size_t in_work_bytes_ = 0;
  std::chrono::nanoseconds expected_compute_{0};
  std::string frame_;
  std::uint64_t object_ = 0;
  std::vector<Member> members_;  ///< empty = no object yet
  SteadyTime last_taken_;
  std::map<std::string, Heard, std::less<>> heard_;  // by probe
};

}  // namespace palpate
