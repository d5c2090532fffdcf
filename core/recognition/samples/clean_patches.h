// The patches in memory as they are fitted: dwells at their means, without spikes. Looked at again
// only where they have changed.
#pragma once

#include <cstddef>
#include <vector>

#include "core/recognition/samples/sample_memory.h"

namespace palpate {

class CleanPatches {
 public:
  /// Looks at the patches of a memory. `default_sigma_m`: noise of samples that state none; 0 = not
  /// known. `false_alarm`: as spikes_of().
  void look_at(const std::vector<StoredPatch>& patches, double default_sigma_m, double false_alarm);

  /// The patches looked at, the samples of each dwell at their mean (dwells.h).
  const std::vector<StoredPatch>& moved() const { return moved_; }
  std::size_t moved_count() const;  ///< of their samples

  /// The same without spikes_of() each.
  const std::vector<StoredPatch>& clean() const { return clean_; }

  void clear();

 private:
  /// What a patch was looked at as.
  struct Seen {
    PatchVersion version;
    bool is_one_place = false;

    bool operator==(const Seen&) const = default;
  };

  std::vector<StoredPatch> moved_;
  std::vector<StoredPatch> clean_;
  std::vector<Seen> seen_;
};

}  // namespace palpate
