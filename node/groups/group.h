// The probes that touch one object: which of their messages count, and what waits for the
// recognizer.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
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
  /// A probe that keeps another object's number is heard once the others have been silent so long.
  std::chrono::duration<double> object_takeover{1.0};
  /// After lost messages the arc is broken where the hole exceeds this many sample spacings.
  double gap_break_spacings = 10.0;
  /// Class that all parts are of: fitted in place of a search. nullopt = it is sought.
  std::optional<CurveClass> given_class = {};
};

/// Belongs to the node's thread. Its recognizer works on a worker's, on one answer at a time: what
/// comes meanwhile waits, and is answered for at once. Load makes answers coarser, never later.
class Group {
 public:
  Group(std::string_view name, const RecognizerOptions& recognizer, const GroupOptions& options)
      : name_(name),
        options_(options),
        recognizer_(std::make_shared<GroupRecognizer>(name, recognizer, options.gap_break_spacings,
                                                      options.given_class)) {}

  /// Whether the message may be taken; REJECT_REASON_UNSPECIFIED = yes. `probe` is its sender,
  /// nullptr where unknown so far. Changes nothing.
  v1::RejectReason judge(const ContactMessage& message, const Probe* probe, SteadyTime now) const;

  /// Takes a message that judge() lets pass; it waits for the recognizer. An object that ends
  /// before its turn is not recognised any more.
  void take(const ContactMessage& message, Continuity continuity, SteadyTime now);

  /// Gives all that waits to the recognizer, which is to run() next. Until end_work() it belongs to
  /// the thread that runs it.
  std::shared_ptr<GroupRecognizer> begin_work();

  /// The recognizer is back; it holds the answer until the next begin_work().
  GroupRecognizer::Answer& end_work();

  bool is_in_work() const { return in_work_; }

  /// What its next answer is taken to need of a core; 0 before the first. As much as the last one,
  /// and half of what was expected of that: an object's first samples, quickly answered, do not
  /// make a group quick whose answers take long. Of a core: who waits for others is not slow.
  std::chrono::nanoseconds expected_compute() const { return expected_compute_; }

  bool is_quick() const { return expected_compute_ <= kQuickCompute; }

  /// An answer that a planner of 50 Hz has in its next period.
  static constexpr std::chrono::milliseconds kQuickCompute{20};

  /// Memory of the messages that wait or are being taken in. [bytes]
  std::size_t queued_bytes() const { return waiting_.bytes() + in_work_bytes_; }

  const std::string& name() const { return name_; }
  std::uint64_t object() const { return object_; }
  std::size_t probe_count() const { return members_.size(); }
  SteadyTime last_taken() const { return last_taken_; }

 private:
  // A probe that has touched the present object.
  struct Member {
    std::string probe;
    SteadyTime last_taken;
  };

  bool is_stale_object(const ContactMessage& message, const Probe* probe, SteadyTime now) const;
  const Member* find_member(std::string_view probe) const;

  std::string name_;
  GroupOptions options_;
  std::shared_ptr<GroupRecognizer> recognizer_;
  ContactQueue waiting_;
  bool in_work_ = false;
  std::size_t in_work_bytes_ = 0;
  std::chrono::nanoseconds expected_compute_{0};
  std::string frame_;
  std::uint64_t object_ = 0;
  std::vector<Member> members_;  ///< empty = no object yet
  SteadyTime last_taken_;
};

}  // namespace palpate
