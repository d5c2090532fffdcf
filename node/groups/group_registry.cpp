#include "node/groups/group_registry.h"

#include <algorithm>
#include <cassert>

namespace palpate {

Group* GroupRegistry::find(std::string_view name) {
  const auto found = groups_.find(name);
  return found == groups_.end() ? nullptr : &found->second.group;
}

std::optional<GroupRegistry::Entries::const_iterator> GroupRegistry::place_for(
    std::string_view probe, SteadyTime now) const {
  auto idle = groups_.end();  // oldest of all
  auto own = groups_.end();   // oldest of those that this probe has opened and touches alone
  std::size_t opened = 0;     // opened by this probe, and not taken over by others
  const auto older = [&](Entries::const_iterator entry, Entries::const_iterator than) {
    return than == groups_.end() ||
           entry->second.group.last_taken() < than->second.group.last_taken();
  };
  for (auto entry = groups_.begin(); entry != groups_.end(); ++entry) {
    const bool is_own = entry->second.opened_by == probe;
    // What others have taken over is theirs: it cannot be given up for this probe's next one.
    if (is_own && !entry->second.group.is_touched_only_by_others_than(probe)) ++opened;
    if (entry->second.group.is_in_work()) continue;  // cannot be evicted now
    if (older(entry, idle)) idle = entry;
    const bool is_shared = entry->second.group.is_touched_by_others_than(probe);
    if (is_own && !is_shared && older(entry, own)) own = entry;
  }
  if (opened >= bounds_.max_groups_per_probe) {
    return own == groups_.end() ? std::nullopt : std::optional(own);
  }
  if (groups_.size() < bounds_.max_groups) return groups_.end();
  if (idle == groups_.end() || now - idle->second.group.last_taken() <= bounds_.evict_idle) {
    return std::nullopt;
  }
  return idle;
}

Group& GroupRegistry::add(std::string_view name, std::string_view probe, SteadyTime now,
                          std::string& evicted) {
  evicted.clear();
  const std::optional<Entries::const_iterator> place = place_for(probe, now);
  assert(place);
  if (*place != groups_.end()) {
    evicted = (*place)->first;
    queued_bytes_ -= (*place)->second.group.queued_bytes();
    count_superseded((*place)->second.group.waiting());
    groups_.erase(*place);
    ++evicted_count_;
  }
  const auto [entry, added] = groups_.try_emplace(
      std::string(name),
      Entry{Group(name, recognizer_options_, group_options_), std::string(probe)});
  assert(added);
  return entry->second.group;
}

void GroupRegistry::count_superseded(const Superseded& more) {
  superseded_samples_ += more.samples;
  superseded_objects_ += more.objects;
}

void GroupRegistry::take(Group& group, const ContactMessage& message, Continuity continuity,
                         SteadyTime now) {
  queued_bytes_ -= group.queued_bytes();
  count_superseded(group.take(message, continuity, now));
  queued_bytes_ += group.queued_bytes();
  Entry& entry = groups_.find(group.name())->second;
  if (entry.waiting) return;
  entry.waiting = true;
  entry.waiting_since = arrivals_++;
  // Unused time does not accumulate: after a pause a group comes first, but not for long.
  entry.served_ns = std::max(entry.served_ns, served_floor_ns_);
}

Group* GroupRegistry::next_waiting(bool only_quick) {
  Entry* next = nullptr;
  for (auto& [name, entry] : groups_) {
    if (!entry.waiting || entry.group.is_in_work()) continue;
    if (only_quick && !entry.group.is_quick()) continue;
    if (next == nullptr || entry.served_ns < next->served_ns ||
        (entry.served_ns == next->served_ns && entry.waiting_since < next->waiting_since)) {
      next = &entry;
    }
  }
  return next == nullptr ? nullptr : &next->group;
}

std::shared_ptr<GroupRecognizer> GroupRegistry::begin_work(Group& group) {
  groups_.find(group.name())->second.waiting = false;
  return group.begin_work();
}

GroupRecognizer::Answer& GroupRegistry::end_work(Group& group) {
  queued_bytes_ -= group.queued_bytes();
  GroupRecognizer::Answer& answer = group.end_work();
  queued_bytes_ += group.queued_bytes();
  Entry& entry = groups_.find(group.name())->second;
  served_floor_ns_ = std::max(served_floor_ns_, entry.served_ns);
  entry.served_ns += answer.processor_ns;
  return answer;
}

bool GroupRegistry::has_work() const {
  return std::any_of(groups_.begin(), groups_.end(), [](const auto& entry) {
    return entry.second.waiting || entry.second.group.is_in_work();
  });
}

}  // namespace palpate
