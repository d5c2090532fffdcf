#include "core/recognition/samples/clean_patches.h"

#include "core/recognition/samples/stored_spikes.h"

namespace palpate {

const std::vector<StoredPatch>& CleanPatches::of(const std::vector<StoredPatch>& patches,
                                                 double false_alarm) {
  clean_.resize(patches.size());
  seen_.resize(patches.size());
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const StoredPatch& patch = patches[p];
    Seen& seen = seen_[p];
    const bool same = seen.samples == patch.samples.size() &&
                      seen.contacts_per_sample == patch.contacts_per_sample &&
                      seen.newest_m == patch.newest_m &&
                      clean_[p].context.probe == patch.context.probe &&
                      clean_[p].context.patch == patch.context.patch;
    if (!same) {
      clean_[p] = patch;
      clean_[p].samples = without_spikes(patch.samples, spikes_of(patch.samples, false_alarm));
      seen = {patch.samples.size(), patch.contacts_per_sample, patch.newest_m};
    }
  }
  return clean_;
}

void CleanPatches::clear() {
  clean_.clear();
  seen_.clear();
}

}  // namespace palpate
