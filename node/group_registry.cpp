#include "node/group_registry.h"

#include <algorithm>
#include <cassert>

namespace palpate {

Group* GroupRegistry::find(std::string_view name) {
  const auto found = groups_.find(name);
  return found == groups_.end() ? nullptr : &found->second.group;
}

GroupRegistry::Entries::const_iterator GroupRegistry::most_idle() const {
  auto idle = groups_.end();
  for (auto entry = groups_.begin(); entry != groups_.end(); ++entry) {
    const Group& group = entry->second.group;
    if (group.is_in_work()) continue;  // somebody else's for now
    if (idle == groups_.end() || group.last_taken() < idle->second.group.last_taken()) idle = entry;
  }
  return idle;
}

bool GroupRegistry::has_room(SteadyTime now) const {
  if (groups_.size() < bounds_.max_groups) return true;
  const auto idle = most_idle();
  return idle != groups_.end() && now - idle->second.group.last_taken() > bounds_.evict_idle;
}

Group& GroupRegistry::add(std::string_view name, std::string& evicted) {
  evicted.clear();
  if (groups_.size() >= bounds_.max_groups) {
    const auto idle = most_idle();
    assert(idle != groups_.end());
    queued_bytes_ -= idle->second.group.queued_bytes();
    evicted = idle->first;
    groups_.erase(idle);
    ++evicted_count_;
  }
  const auto [entry, added] = groups_.try_emplace(
      std::string(name), Entry{Group(name, recognizer_options_, group_options_)});
  assert(added);
  return entry->second.group;
}

void GroupRegistry::take(Group& group, const ContactMessage& message, Continuity continuity,
                         SteadyTime now) {
  queued_bytes_ -= group.queued_bytes();
  group.take(message, continuity, now);
  queued_bytes_ += group.queued_bytes();
  Entry& entry = groups_.find(group.name())->second;
  if (entry.waiting) return;
  entry.waiting = true;
  entry.waiting_since = arrivals_++;
  // Time not asked for is not saved up: after a pause a group is first, but not for long.
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
  entry.served_ns += answer.compute_ns;
  return answer;
}

bool GroupRegistry::has_work() const {
  return std::any_of(groups_.begin(), groups_.end(), [](const auto& entry) {
    return entry.second.waiting || entry.second.group.is_in_work();
  });
}

}  // namespace palpate
