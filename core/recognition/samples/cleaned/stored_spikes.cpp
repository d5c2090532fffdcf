#include "core/recognition/samples/cleaned/stored_spikes.h"

#include "core/local/spikes/spikes.h"
#include "core/recognition/samples/cleaned/relative_noise.h"

namespace palpate {

std::vector<bool> spikes_of(std::span<const StoredSample> samples, double false_alarm,
                            WorkBudget& work, const CuspEnds& cusps,
                            std::span<const RelativeNoise> noise) {
  std::vector<Vec2> positions;
  positions.reserve(samples.size());
  for (const StoredSample& sample : samples) {
    positions.push_back(sample.position_m);
  }
  std::vector<bool> is_spike(samples.size(), false);
  for (const std::size_t i :
       find_spikes(
           positions,
           {.noise = noise, .false_alarms_per_patch = false_alarm, .cusps = cusps, .work = &work})
           .indices) {
    is_spike[i] = true;
  }
  return is_spike;
}

std::vector<bool> spikes_of(const StoredPatch& patch, double default_sigma_m, double false_alarm,
                            WorkBudget& work) {
  return spikes_of(patch.samples, false_alarm, work, {},
                   relative_noise(patch, default_sigma_m, 0.0));
}

std::vector<StoredSample> without_spikes(std::span<const StoredSample> samples,
                                         const std::vector<bool>& is_spike) {
  std::vector<StoredSample> kept;
  kept.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!is_spike[i]) {
      kept.push_back(samples[i]);
    }
  }
  return kept;
}

StoredPatch without_spikes(const StoredPatch& patch, const std::vector<bool>& is_spike) {
  StoredPatch kept = patch;
  kept.samples = without_spikes(patch.samples, is_spike);
  if (!patch.details.empty()) {
    kept.details.clear();
    for (std::size_t i = 0; i < patch.details.size(); ++i) {
      if (!is_spike[i]) {
        kept.details.push_back(patch.details[i]);
      }
    }
  }
  return kept;
}

}  // namespace palpate
