#include "node/groups/group.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace palpate {

const Group::Member* Group::find_member(std::string_view probe) const {
  const auto found = std::find_if(members_.begin(), members_.end(),
                                  [&](const Member& member) { return member.probe == probe; });
  return found == members_.end() ? nullptr : &*found;
}

// When one probe of several announces a new object, the others' last messages of the old object are
// still on their way. They must neither be mixed into the new object nor bring the old one back. So
// an object begins only with a probe that changes its own number; any other probe waits until the
// others are silent. So does one that was started anew and counts its objects from where it once
// began.
bool Group::is_stale_object(const ContactMessage& message, const Probe* probe,
                            SteadyTime now) const {
  if (members_.empty() || message.object == object_) return false;
  // In the order of each group alone, the probe's latest message may be another group's.
  const auto heard = heard_.find(message.probe);
  const bool was_here = heard != heard_.end();
  if (was_here || (probe != nullptr && probe->object && probe->group == name_)) {
    const std::uint64_t before = was_here ? heard->second.object : *probe->object;
    const SequenceTracker& sequence = was_here ? heard->second.sequence : probe->sequence;
    const bool counts_anew = sequence.epoch() != message.epoch && message.object < object_;
    if (before != message.object && !counts_anew) return false;
  }
  return std::any_of(members_.begin(), members_.end(), [&](const Member& member) {
    return member.probe != message.probe && now - member.last_taken <= options_.object_takeover;
  });
}

v1::RejectReason Group::judge(const ContactMessage& message, const Probe* probe,
                              SteadyTime now) const {
  if (is_stale_object(message, probe, now)) return v1::REJECT_REASON_STALE_OBJECT;
  if (members_.empty() || message.object != object_) return v1::REJECT_REASON_UNSPECIFIED;
  if (message.frame != frame_) return v1::REJECT_REASON_FRAME_NAME;
  if (find_member(message.probe) == nullptr && members_.size() >= options_.max_probes_per_group) {
    return v1::REJECT_REASON_TOO_MANY_PROBES_IN_GROUP;
  }
  return v1::REJECT_REASON_UNSPECIFIED;
}

Superseded Group::take(const ContactMessage& message, Continuity continuity, SteadyTime now) {
  const bool begins_object = members_.empty() || message.object != object_;
  Superseded superseded;
  if (begins_object) {
    superseded = waiting();
    was_begun_ = false;
    waiting_.clear();
    members_.clear();
    frame_ = message.frame;
    object_ = message.object;
  }
  auto member = std::find_if(members_.begin(), members_.end(),
                             [&](const Member& known) { return known.probe == message.probe; });
  if (member == members_.end()) {
    members_.push_back({std::string(message.probe), now});
  } else {
    member->last_taken = now;
  }
  last_taken_ = now;
  waiting_.push(message, continuity, begins_object);
  return superseded;
}

bool Group::is_touched_only_by_others_than(std::string_view probe) const {
  return !members_.empty() && find_member(probe) == nullptr;
}

bool Group::is_touched_by_others_than(std::string_view probe) const {
  return std::any_of(members_.begin(), members_.end(),
                     [&](const Member& member) { return member.probe != probe; });
}

const SequenceTracker* Group::sequence_of(std::string_view probe) const {
  const auto found = heard_.find(probe);
  return found == heard_.end() ? nullptr : &found->second.sequence;
}

SequenceEvent Group::take_sequence(const ContactMessage& message) {
  auto found = heard_.find(message.probe);
  if (found == heard_.end()) found = heard_.emplace(std::string(message.probe), Heard()).first;
  found->second.object = message.object;
  return found->second.sequence.take(message.epoch, message.seq);
}

void Group::forget_probe(std::string_view probe) {
  if (const auto found = heard_.find(probe); found != heard_.end()) heard_.erase(found);
}

std::shared_ptr<GroupRecognizer> Group::begin_work() {
  assert(!in_work_);
  in_work_ = true;
  was_begun_ = true;
  in_work_bytes_ = waiting_.bytes();
  // The recognizer's queue is empty: it has processed its messages.
  std::swap(recognizer_->contacts, waiting_);
  return recognizer_;
}

GroupRecognizer::Answer& Group::end_work() {
  assert(in_work_);
  in_work_ = false;
  in_work_bytes_ = 0;
  expected_compute_ =
      std::max(std::chrono::nanoseconds(recognizer_->answer.processor_ns), expected_compute_ / 2);
  return recognizer_->answer;
}

}  // namespace palpate
