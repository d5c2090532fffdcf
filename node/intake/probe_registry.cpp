#include "node/intake/probe_registry.h"

#include <algorithm>
#include <cassert>

namespace palpate {

Probe* ProbeRegistry::find(std::string_view name) {
  const auto found = probes_.find(name);
  return found == probes_.end() ? nullptr : &found->second;
}

std::map<std::string, Probe, std::less<>>::const_iterator ProbeRegistry::most_idle() const {
  return std::min_element(probes_.begin(), probes_.end(), [](const auto& a, const auto& b) {
    return a.second.last_heard < b.second.last_heard;
  });
}

bool ProbeRegistry::has_room(SteadyTime now) const {
  if (probes_.size() < max_probes_) return true;
  const auto idle = most_idle();
  return idle != probes_.end() && now - idle->second.last_heard > evict_idle_;
}

Probe& ProbeRegistry::add(std::string_view name, SteadyTime now, std::string& evicted) {
  assert(has_room(now));
  evicted.clear();
  if (probes_.size() >= max_probes_) {
    const auto idle = most_idle();
    evicted = idle->first;
    evicted_gaps_ += idle->second.sequence.gaps();
    evicted_missing_ += idle->second.sequence.missing();
    evicted_restarts_ += idle->second.sequence.restarts();
    ++evicted_count_;
    probes_.erase(idle);
  }
  Probe& probe = probes_[std::string(name)];
  probe.name = name;
  probe.last_heard = now;
  return probe;
}

std::uint64_t ProbeRegistry::gaps() const {
  std::uint64_t sum = evicted_gaps_;
  for (const auto& [name, probe] : probes_) sum += probe.sequence.gaps();
  return sum;
}

std::uint64_t ProbeRegistry::missing() const {
  std::uint64_t sum = evicted_missing_;
  for (const auto& [name, probe] : probes_) sum += probe.sequence.missing();
  return sum;
}

std::uint64_t ProbeRegistry::restarts() const {
  std::uint64_t sum = evicted_restarts_;
  for (const auto& [name, probe] : probes_) sum += probe.sequence.restarts();
  return sum;
}

}  // namespace palpate
