// The patches in memory without their spikes, looked at again only where they have changed.
#pragma once

#include <cstddef>
#include <vector>

#include "core/recognition/samples/sample_memory.h"

namespace palpate {

class CleanPatches {
 public:
  /// `patches` without spikes_of() each. What is returned stays until the next call.
  const std::vector<StoredPatch>& of(const std::vector<StoredPatch>& patches, double false_alarm);

  void clear();

 private:
  /// What tells that a patch has not changed.
  struct Seen {
    std::size_t samples = 0;
    double contacts_per_sample = 0.0;
    Vec2 newest_m = Vec2::Zero();
  };

  std::vector<StoredPatch> clean_;
  std::vector<Seen> seen_;
};

}  // namespace palpate
