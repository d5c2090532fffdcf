// Prepares the patches in memory for fitting: each dwell replaced by its mean, strokes cut where
// they turn back, spikes removed. Only patches that changed are processed again.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Identifies a state of a patch in memory, whose samples only grow at their end: equal versions
/// mean an unchanged patch.
struct PatchVersion {
  PatchContext context;
  std::size_t samples = 0;
  double contacts_per_sample = 0.0;
  Vec2 newest_m = Vec2::Zero();

  bool operator==(const PatchVersion&) const = default;
};

inline PatchVersion version_of(const StoredPatch& patch) {
  return {patch.context, patch.samples.size(), patch.contacts_per_sample, patch.newest_m};
}

struct CleanOptions {
  double default_sigma_m = 0.0;   ///< noise of samples that state none; 0 = not known [m]
  double form_deviation_m = 0.0;  ///< as RecognizerOptions::form_deviation_m [m]
  double false_alarm = 0.0;       ///< as in spikes_of()
};

class CleanPatches {
 public:
  /// Processes the patches of a memory.
  void update(std::span<const StoredPatch> patches, const CleanOptions& options, WorkBudget& work);

  /// The patches with each dwell replaced by its mean (dwell_means.h), and so single touches of one
  /// place (repeated_touches.h), cut where they turn back over themselves (passes.h). Spikes are
  /// still in them.
  const std::vector<StoredPatch>& moved() const { return moved_; }
  std::size_t moved_count() const;  ///< number of their samples
  /// Number of contacts that only repeat the place of one of these samples.
  std::size_t dwelling_count() const;

  /// The patches of moved() without the spikes of each.
  const std::vector<StoredPatch>& clean() const { return clean_; }

  void clear();

 private:
  /// A patch of the memory and the results for it.
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
