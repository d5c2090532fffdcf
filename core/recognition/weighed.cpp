#include "core/recognition/weighed.h"

#include <cmath>

#include "core/curves/curve.h"

namespace palpate {

double residual_noise_m(const Weighing& w) {
  return w.sigma * w.data.scale * std::sqrt(w.seen.white_variance);
}

std::optional<ExplainingCurve> curve_of(const CanonicalFit& fit, double noise_m) {
  return make_curve(fit.shape.curve_class, fit.shape.values)
             ? std::optional(ExplainingCurve{fit.shape, fit.world_T_curve, noise_m})
             : std::nullopt;
}

std::optional<ExplainingCurve> curve_of(const Weighing& w) {
  const auto& best = w.canonical[w.best];
  return best ? curve_of(*best, residual_noise_m(w)) : std::nullopt;
}

}  // namespace palpate
