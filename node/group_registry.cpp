#include "node/group_registry.h"

#include <algorithm>
#include <cassert>

namespace palpate {

Group* GroupRegistry::find(std::string_view name) {
  const auto found = groups_.find(name);
  return found == groups_.end() ? nullptr : &found->second.group;
}

GroupRegistry::Entries::const_iterator GroupRegistry::most_idle() const {
  return std::min_element(groups_.begin(), groups_.end(), [](const auto& a, const auto& b) {
    return a.second.group.last_taken() < b.second.group.last_taken();
  });
}

bool GroupRegistry::has_room(SteadyTime now) const {
  if (groups_.size() < max_groups_) return true;
  const auto idle = most_idle();
  return idle != groups_.end() && now - idle->second.group.last_taken() > evict_idle_;
}

Group& GroupRegistry::add(std::string_view name, std::string& evicted) {
  evicted.clear();
  if (groups_.size() >= max_groups_) {
    const auto idle = most_idle();
    evicted = idle->first;
    groups_.erase(idle);
    ++evicted_count_;
  }
  const auto [entry, added] = groups_.try_emplace(
      std::string(name), Entry{Group(name, recognizer_options_, group_options_)});
  assert(added);
  return entry->second.group;
}

void GroupRegistry::mark_waiting(const Group& group) {
  Entry& entry = groups_.find(group.name())->second;
  if (entry.waiting) return;
  entry.waiting = true;
  entry.waiting_since = arrivals_++;
  // Time not asked for is not saved up: after a pause a group is first, but not for long.
  entry.served_ns = std::max(entry.served_ns, served_floor_ns_);
}

Group* GroupRegistry::next_waiting() {
  Entry* next = nullptr;
  for (auto& [name, entry] : groups_) {
    if (!entry.waiting) continue;
    if (next == nullptr || entry.served_ns < next->served_ns ||
        (entry.served_ns == next->served_ns && entry.waiting_since < next->waiting_since)) {
      next = &entry;
    }
  }
  return next == nullptr ? nullptr : &next->group;
}

void GroupRegistry::mark_served(const Group& group, std::int64_t compute_ns) {
  Entry& entry = groups_.find(group.name())->second;
  entry.waiting = false;
  served_floor_ns_ = std::max(served_floor_ns_, entry.served_ns);
  entry.served_ns += compute_ns;
}

}  // namespace palpate
