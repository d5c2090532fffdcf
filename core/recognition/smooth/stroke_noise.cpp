#include "core/recognition/smooth/stroke_noise.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/local/noise.h"
#include "core/recognition/smooth/variance_ratio.h"

namespace palpate {
namespace {

/// The variance of a sample of weight 1 in a stroke, in the units of the points.
struct StrokeVariance {
  double value = 0.0;
  double dof = 0.0;  ///< 0: the stroke does not show it
};

StrokeVariance variance_of(std::span<const FitPoint> stroke, double least) {
  std::vector<Vec2> positions;
  double weights = 0.0;
  for (const FitPoint& point : stroke) {
    positions.push_back(point.position);
    weights += point.inverse_sigma * point.inverse_sigma;
  }
  const NoiseEstimate noise = estimate_noise(positions);
  if (noise.status != LocalStatus::Ok) {
    return {};
  }
  const double sigma = std::max(noise.sigma_m, least);
  return {sigma * sigma * weights / static_cast<double>(stroke.size()),
          static_cast<double>(noise.dof)};
}

/// Of all strokes together.
StrokeVariance pooled(const std::vector<StrokeVariance>& strokes) {
  StrokeVariance all;
  for (const StrokeVariance& stroke : strokes) {
    all.value += stroke.dof * stroke.value;
    all.dof += stroke.dof;
  }
  all.value /= std::max(all.dof, 1.0);
  return all;
}

/// Of all but one.
StrokeVariance without(const StrokeVariance& stroke, const StrokeVariance& all) {
  const double dof = all.dof - stroke.dof;
  const double sum = all.dof * all.value - stroke.dof * stroke.value;
  return {std::max(sum, 0.0) / std::max(dof, 1.0), dof};
}

bool differs(const StrokeVariance& stroke, const StrokeVariance& others) {
  return stroke.dof > 0.0 && others.dof > 0.0 &&
         is_ratio_beyond_chance(stroke.value / others.value, stroke.dof, others.dof);
}

}  // namespace

void weigh_strokes(FitData* data) {
  if (data->patches.size() < 2) {
    return;
  }
  const double least = std::max({rounding_level(*data), data->reading_noise, kExact});
  std::vector<StrokeVariance> strokes;
  for (std::size_t p = 0; p < data->patches.size(); ++p) {
    strokes.push_back(variance_of(data->patch(p), least));
  }
  const StrokeVariance all = pooled(strokes);
  if (std::none_of(strokes.begin(), strokes.end(), [&](const StrokeVariance& stroke) {
        return differs(stroke, without(stroke, all));
      })) {
    return;
  }
  for (std::size_t p = 0; p < strokes.size(); ++p) {
    const double ratio = strokes[p].dof > 0.0 ? std::sqrt(all.value / strokes[p].value) : 1.0;
    for (std::size_t i = data->patches[p].begin; i < data->patches[p].end; ++i) {
      data->points[i].inverse_sigma *= ratio;
    }
  }
}

}  // namespace palpate
