#include "core/recognition/weigh/weigh_in_full.h"

#include <utility>

#include "core/recognition/smooth/across_noise.h"
#include "core/recognition/weigh/best_in_full.h"

namespace palpate {

Weighing weigh_in_full(const FitData& data, std::span<const StoredPatch> patches, WorkBudget& work,
                       const WeighOptions& options, std::span<const SidedStart> starts) {
  Weighing w = weigh(data, patches, work, options, starts);
  if (data.details.empty()) {
    return w;
  }
  // Where no path told what of the noise lies across, the best class's curve does, for every class.
  if (has_covariances(w.data) && w.canonical[w.best] && w.fits[w.best]->on_all && work.allows()) {
    w = weigh(weighed_across(*w.canonical[w.best], w.data, data), patches, work, options, starts);
  }
  return work.allows() ? best_in_full(std::move(w), data, work) : w;
}

}  // namespace palpate
