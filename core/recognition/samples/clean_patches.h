// The patches in memory as they are fitted: dwells at their means, one way each, without spikes.
// Looked at again only where they have changed.
#pragma once

#include <cstddef>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/samples/sample_memory.h"

namespace palpate {

class CleanPatches {
 public:
  /// Looks at the patches of a memory. `default_sigma_m`: noise of samples that state none; 0 = not
  /// known. `false_alarm`, `work`: as spikes_of(). A patch in which `work` ended is looked at
  /// again.
  void look_at(const std::vector<StoredPatch>& patches, double default_sigma_m, double false_alarm,
               WorkBudget& work);

  /// The patches looked at, the samples of each dwell at their mean (dwells.h), and each patch cut
  /// where it turns back over itself (passes.h).
  const std::vector<StoredPatch>& moved() const { return moved_; }
  std::size_t moved_count() const;     ///< of their samples
  std::size_t dwelling_count() const;  ///< of contacts that repeat a place of these

  /// The same without spikes_of() each.
  const std::vector<StoredPatch>& clean() const { return clean_; }

  void clear();

 private:
  /// A patch, what it was looked at as, and its passes.
  struct Seen {
    PatchVersion version;
    bool is_one_place = false;
    std::vector<StoredPatch> moved = {};
    std::vector<StoredPatch> clean = {};
  };

  std::vector<Seen> seen_;
  std::vector<StoredPatch> moved_;
  std::vector<StoredPatch> clean_;
};

}  // namespace palpate
