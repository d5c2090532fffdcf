#include "core/recognition/samples/clean_patches.h"

#include "core/recognition/samples/stored_spikes.h"

namespace palpate {

const std::vector<StoredPatch>& CleanPatches::of(const std::vector<StoredPatch>& patches,
                                                 double false_alarm) {
  clean_.resize(patches.size());
  seen_.resize(patches.size());
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const StoredPatch& patch = patches[p];
    const PatchVersion version = version_of(patch);
    if (!(seen_[p] == version)) {
      clean_[p] = without_spikes(patch, spikes_of(patch.samples, false_alarm));
      seen_[p] = version;
    }
  }
  return clean_;
}

void CleanPatches::clear() {
  clean_.clear();
  seen_.clear();
}

}  // namespace palpate
