#include "core/recognition/smooth/arcs.h"

#include <algorithm>
#include <utility>

#include "core/recognition/smooth/across_noise.h"

namespace palpate {
namespace {

/// Sets the noise of points that bring none from the smooth model's residuals. Returns whether it
/// is as good as known: no smaller than rounding.
bool estimate_noise(FitData* data, SmoothModel* smooth) {
  // With too few degrees of freedom there is no estimate; what fits to a millionth of the extent is
  // then as good as exact.
  constexpr double kNoEstimate = 1e-6;
  const double rounding = rounding_level(*data);
  const double estimate =
      smooth->dof() >= kFewestDegreesOfNoise ? smooth->noise_ratio() : kNoEstimate;
  const double sigma = std::max(estimate, rounding);
  scale_noise(sigma, data, smooth);
  return estimate <= rounding;
}

}  // namespace

Arcs smooth_arcs(FitData data, bool sigma_known) {
  Arcs arcs;
  arcs.smooth = fit_smooth_model(&data, sigma_known);
  if (!data.details.empty() && weigh_across_path(arcs.smooth, &data)) {
    arcs.smooth = fit_smooth_model(&data, sigma_known);
  }
  arcs.sigma_known = sigma_known || estimate_noise(&data, &arcs.smooth);
  arcs.sigma = rms_sigma(data);
  arcs.data = std::move(data);
  return arcs;
}

}  // namespace palpate
