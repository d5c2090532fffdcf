#include "core/recognition/counted/weighed.h"

#include <cmath>

#include "core/curves/curve.h"

namespace palpate {

std::span<const StoredPatch> patches_of(const Weighed& weighed,
                                        std::span<const StoredPatch> asked) {
  return weighed.patches ? *weighed.patches : asked;
}

double signed_distance_m(const ExplainingCurve& from, const StoredSample& sample,
                         double tip_radius_m) {
  const Curve curve = *make_curve(from.shape.curve_class, from.shape.values);
  const FootPoint foot = foot_point(curve, from.world_T_curve.to_local(sample.position_m));
  return tip_radius_m > 0.0 ? std::abs(foot.distance) - tip_radius_m : foot.distance;
}

double distance_m(const ExplainingCurve& from, const StoredSample& sample, double tip_radius_m) {
  return std::abs(signed_distance_m(from, sample, tip_radius_m));
}

double noise_m(const ExplainingCurve& about, const StoredSample& sample) {
  return sigma_m_of(sample, about.noise_m) / std::sqrt(sample.weight);
}

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
