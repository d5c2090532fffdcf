#include "core/recognition/fit_data.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {

double rounding_level(const FitData& data) {
  // A coordinate carries half a unit in the last place; a few such errors meet in a residual.
  constexpr double kRoundings = 4.0;
  const double largest = data.centre.cwiseAbs().maxCoeff() + data.scale;
  return kRoundings * std::numeric_limits<double>::epsilon() * largest / data.scale;
}

FitData make_fit_data(std::span<const StoredPatch> patches, double default_sigma_m,
                      bool* sigma_known) {
  FitData data;
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 high = -low;
  for (const StoredPatch& patch : patches) {
    for (const StoredSample& sample : patch.samples) {
      low = low.cwiseMin(sample.position_m);
      high = high.cwiseMax(sample.position_m);
    }
  }
  *sigma_known = true;
  if (!(low.x() <= high.x())) {
    return data;
  }
  data.centre = low + 0.5 * (high - low);
  const double half_extent = 0.5 * (high - low).maxCoeff();
  data.scale = half_extent > 0.0 ? half_extent : 1.0;
  const double least_sigma = rounding_level(data);
  for (const StoredPatch& patch : patches) {
    if (patch.samples.empty()) {
      continue;
    }
    const std::size_t begin = data.points.size();
    for (const StoredSample& sample : patch.samples) {
      const double sigma_m = sample.sigma_m > 0.0 ? sample.sigma_m : default_sigma_m;
      *sigma_known = *sigma_known && sigma_m > 0.0;
      FitPoint point;
      point.position = (sample.position_m - data.centre) / data.scale;
      point.offset = patch.context.tip_radius_m / data.scale;
      const double sigma = sigma_m > 0.0 ? std::max(sigma_m / data.scale, least_sigma) : 1.0;
      point.inverse_sigma = std::sqrt(sample.weight) / sigma;
      data.points.push_back(point);
    }
    data.patches.push_back({begin, data.points.size()});
  }
  if (!*sigma_known) {
    // Stated and unstated noise do not mix: the data decide for all.
    std::size_t i = 0;
    for (const StoredPatch& patch : patches) {
      for (const StoredSample& sample : patch.samples) {
        data.points[i++].inverse_sigma = std::sqrt(sample.weight);
      }
    }
  }
  return data;
}

}  // namespace palpate
