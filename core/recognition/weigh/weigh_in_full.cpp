#include "core/recognition/weigh/weigh_in_full.h"

#include <optional>
#include <utility>

#include "core/recognition/smooth/across_noise.h"
#include "core/recognition/weigh/best_in_full.h"

namespace palpate {
namespace {

/// The data with the noise that lies across the best class's curve where no path told it, as every
/// class is then judged by; nullopt where the path told it of all points, or no class is placed on
/// all points.
std::optional<FitData> weighed_across(const Weighing& w, const FitData& data) {
  if (!has_covariances(w.data) || !w.canonical[w.best] || !w.fits[w.best]->on_all) {
    return std::nullopt;
  }
  FitData weighed = data;
  const double rounding = rounding_level(data);
  for (std::size_t i = 0; i < data.details.size(); ++i) {
    if (w.data.details[i].covariance.x() > 0.0) {
      const Vec2 normal = data.frame.rotate_back(w.canonical[w.best]->points[i].normal);
      weigh_across(normal, rounding, &weighed.details[i], &weighed.points[i]);
    }
  }
  return weighed;
}

}  // namespace

Weighing weigh_in_full(const FitData& data, std::span<const StoredPatch> patches, WorkBudget& work,
                       const WeighOptions& options, std::span<const SidedStart> starts) {
  Weighing w = weigh(data, patches, work, options, starts);
  if (data.details.empty()) {
    return w;
  }
  const auto across = weighed_across(w, data);
  if (across && work.allows()) {
    w = weigh(*across, patches, work, options, starts);
  }
  return work.allows() ? best_in_full(std::move(w), data, work) : w;
}

}  // namespace palpate
