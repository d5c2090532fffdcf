#include "node/group.h"

#include <algorithm>
#include <span>

namespace palpate {

const Group::Member* Group::find_member(std::string_view probe) const {
  const auto found = std::find_if(members_.begin(), members_.end(),
                                  [&](const Member& member) { return member.probe == probe; });
  return found == members_.end() ? nullptr : &*found;
}

// With several probes, the others' last messages of the old object arrive after the first probe has
// announced the new one. They must neither be mixed into the new object nor bring the old one back:
// only a probe that changes its own number begins an object. A probe that has never said otherwise
// waits until the others are silent.
bool Group::is_stale_object(const ContactMessage& message, const Probe* probe,
                            SteadyTime now) const {
  if (members_.empty() || message.object == object_) return false;
  const bool announces_change = probe != nullptr && probe->object && probe->group == name_ &&
                                *probe->object != message.object;
  if (announces_change) return false;
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

void Group::begin_object(const ContactMessage& message) {
  recognizer_.reset();
  members_.clear();
  frame_ = message.frame;
  object_ = message.object;
  newest_.sample_stamp_ns = message.newest_sample_stamp_ns;
}

std::size_t Group::take(const ContactMessage& message, Continuity continuity, SteadyTime now) {
  if (members_.empty() || message.object != object_) begin_object(message);
  if (find_member(message.probe) == nullptr) {
    members_.push_back({std::string(message.probe), PatchNumbering(), now});
  }
  const auto index = static_cast<std::size_t>(find_member(message.probe) - members_.data());
  Member& member = members_[index];
  if (continuity == Continuity::Anew) member.patches.end_run();
  member.last_taken = now;
  last_taken_ = now;

  PatchContext context;
  context.probe = static_cast<std::uint32_t>(index);
  context.patch = member.patches.run_of(message.patch, continuity == Continuity::SamplesMissing,
                                        options_.gap_break_spacings, message.samples);
  context.tip_radius_m = message.tip_radius_m;
  context.material_side = message.material_side;
  const AddResult added = recognizer_.add(context, message.samples);

  newest_.source = message.probe;
  newest_.epoch = message.epoch;
  newest_.seq = message.seq;
  newest_.sample_stamp_ns = std::max(newest_.sample_stamp_ns, message.newest_sample_stamp_ns);
  return message.samples.size() - added.accepted;
}

ContactSource Group::source_of(std::uint32_t probe, std::uint32_t run) const {
  if (probe >= members_.size()) return {};
  return {members_[probe].probe, members_[probe].patches.wire_patch(run).value_or(0)};
}

}  // namespace palpate
