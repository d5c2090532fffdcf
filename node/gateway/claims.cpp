#include "node/gateway/claims.h"

#include <algorithm>
#include <utility>

namespace palpate::gateway {

using std::chrono::milliseconds;

Claims::Claims(std::uint64_t own_id, std::vector<std::string> places, std::size_t most,
               SteadyTime now)
    : id_(own_id), most_(most), last_heard_of_us_(now), random_state_(own_id | 1U) {
  for (std::string& place : places) {
    claims_[std::move(place)] = {false, false, now, some_patience()};
  }
}

/// Random, so that processes waiting for the same place do not take it at the same moment.
milliseconds Claims::some_patience() {
  random_state_ = random_state_ * 6364136223846793005U + 1442695040888963407U;
  return kSilence + milliseconds((random_state_ >> 33U) % 150U);
}

void Claims::hear(std::string_view place, std::uint64_t id, SteadyTime now) {
  const auto found = claims_.find(place);
  if (found == claims_.end() || id == id_) return;
  Claim& claim = found->second;
  claim.last_heard = now;
  claim.patience = some_patience();
  if (claim.is_own && id < id_) claim.is_contested = true;
}

Claims::Changes Claims::decide(bool is_heard, SteadyTime now) {
  Changes changes;
  // For the others, a process that could not be heard or did not run for this long is gone.
  const bool was_silent = now - last_heard_of_us_ > kSilence;
  if (is_heard) last_heard_of_us_ = now;
  std::size_t count = 0;
  for (auto& [place, claim] : claims_) {
    if (claim.is_own && (was_silent || claim.is_contested)) {
      claim = {false, false, now, some_patience()};
      changes.release.push_back(place);
    }
    count += claim.is_own ? 1U : 0U;
  }
  if (!is_heard || was_silent) {
    // While we hear nothing, we cannot say that an owner is silent.
    for (auto& [place, claim] : claims_) {
      if (!claim.is_own) claim.last_heard = now;
    }
    return changes;
  }
  for (auto& [place, claim] : claims_) {
    if (claim.is_own || count >= most_ || now - claim.last_heard < claim.patience) continue;
    claim.is_own = true;
    claim.is_contested = false;
    ++count;
    changes.take.push_back(place);
    // One at a time, so that other processes get places too.
    if (claims_.size() > 1) break;
  }
  return changes;
}

std::vector<std::string> Claims::own() const {
  std::vector<std::string> places;
  for (const auto& [place, claim] : claims_) {
    if (claim.is_own) places.push_back(place);
  }
  return places;
}

}  // namespace palpate::gateway
