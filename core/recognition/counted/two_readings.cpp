#include "core/recognition/counted/two_readings.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/numerics/probability/chi_square.h"
#include "core/numerics/probability/mahalanobis.h"
#include "core/recognition/counted/outliers.h"
#include "core/recognition/samples/cleaned/stored_spikes.h"

namespace palpate {
namespace {

/// log of the factor by which the variances that the evidence was computed with exceed those of the
/// points, times half their number.
double log_of_wider_noise(const Weighing& w) {
  const Likelihood& law = w.seen.likelihood ? *w.seen.likelihood : w.stated;
  const double residuals = static_cast<double>(residual_count(w.data));
  return 0.5 * law.samples * std::log(law.tempering * law.samples / residuals);
}

/// log of the density of samples that are spikes, over the odds against them. Nothing is known of
/// how high one is, between its noise and the size of the part: not even the order of magnitude.
double log_density_of(std::span<const SetAside> spikes, const ExplainingCurve& of, double size_m) {
  double log_density = 0.0;
  for (const auto& [sample, tip_radius_m] : spikes) {
    const double sigma_m = noise_m(of, sample);
    const double height_m = std::max(distance_m(of, sample, tip_radius_m), sigma_m);
    const double orders = std::max(std::log(size_m / sigma_m), 1.0);
    log_density -= std::log(2.0 * height_m * orders) + log_odds(1.0 - kGross);
  }
  return log_density;
}

/// log of the density of all samples by one reading, [1/m] each.
double log_density_of(const Weighed& reading, const ExplainingCurve& curve,
                      std::span<const SetAside> spikes) {
  const Weighing& w = reading.w;
  double log_density = w.log_evidence - log_of_wider_noise(w);
  for (const FitPoint& point : w.data.points) {
    log_density += std::log(point.inverse_sigma / w.data.scale / std::sqrt(2.0 * std::numbers::pi));
  }
  return log_density + log_density_of(spikes, curve, 2.0 * w.data.scale);
}

/// Whether a fit lies outside of the 95 % ellipsoid of another one of its class, whose covariance
/// is `inflation` times what its fit has. (One sample more or less seldom leads so far, unless the
/// shape rests on it.)
bool is_another(const CanonicalFit& fit, const CanonicalFit& told, double inflation) {
  constexpr double kBeyond = 0.05;
  const Eigen::Index n = told.covariance.rows() - 3;  // parameters of the shape
  const Pose2& from = told.world_T_curve;
  const Pose2& to = fit.world_T_curve;
  Eigen::VectorXd step(n + 3);
  step << (fit.shape.values - told.shape.values).head(n), to.x - from.x, to.y - from.y,
      wrap_angle(to.theta - from.theta);
  const double square = mahalanobis_square(step, told.covariance) / inflation;
  return !(chi_square_survival(square, static_cast<int>(n + 3)) > kBeyond);
}

/// The reading that is `told`, with the probabilities of both: those of the other reading count by
/// the `share` that it has. A class of the other reading gets at most what the best class told has:
/// more would make another class the answer, with a shape that is not its own.
Weighed with_share_of(Weighed rest, double share, Weighed told) {
  Weighing& w = told.w;
  double sum = 0.0;
  ByClass<double> by_both{};
  for (std::size_t i = 0; i < by_both.size(); ++i) {
    const double by_told = (1.0 - share) * w.probabilities[i];
    const double by_rest = share * rest.w.probabilities[i];
    by_both[i] = by_told + by_rest;
    if (i != static_cast<std::size_t>(w.best) && by_rest > by_told && rest.w.fits[i]) {
      w.fits[i] = std::move(rest.w.fits[i]);
      w.canonical[i] = std::move(rest.w.canonical[i]);
      w.residuals[i] = rest.w.residuals[i];
      if (w.canonical[i]) {
        w.canonical[i]->covariance *= rest.w.inflation / w.inflation;
      }
    }
  }
  for (double& probability : by_both) {
    probability = std::min(probability, by_both[w.best]);
    sum += probability;
  }
  for (double& probability : by_both) {
    probability /= sum;
  }
  w.probabilities = by_both;
  if (rest.w.best == w.best &&
      is_another(*rest.w.canonical[w.best], *w.canonical[w.best], w.inflation)) {
    w.rival_share = std::max(w.rival_share, share);
  }
  return told;
}

}  // namespace

Weighed more_probable(Weighed one, Weighed other, std::span<const StoredPatch> patches,
                      std::span<const StoredPatch> all) {
  const auto curve_of_one = curve_of(one.w);
  const auto curve_of_other = curve_of(other.w);
  if (!curve_of_one || !curve_of_other) {
    return one;
  }
  const auto aside_of = [&](const Weighed& weighed) {
    const std::span<const StoredPatch> used = patches_of(weighed, patches);
    return flagged_samples(all, samples_set_aside(all, used, weighed.outliers));
  };
  const double log_of_one = log_density_of(one, *curve_of_one, aside_of(one));
  const double log_of_other = log_density_of(other, *curve_of_other, aside_of(other));
  const double share = 1.0 / (1.0 + std::exp(std::abs(log_of_one - log_of_other)));
  return log_of_other > log_of_one ? with_share_of(std::move(one), share, std::move(other))
                                   : with_share_of(std::move(other), share, std::move(one));
}

}  // namespace palpate
