// The patches in memory without their spikes, looked at again only where they have changed.
#pragma once

#include <vector>

#include "core/recognition/samples/sample_memory.h"

namespace palpate {

class CleanPatches {
 public:
  /// `patches` without spikes_of() each. What is returned stays until the next call.
  const std::vector<StoredPatch>& of(const std::vector<StoredPatch>& patches, double false_alarm);

  void clear();

 private:
  std::vector<StoredPatch> clean_;
  std::vector<PatchVersion> seen_;  ///< of the patches as they came
};

}  // namespace palpate
