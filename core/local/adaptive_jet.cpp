#include "core/local/adaptive_jet.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/local/aligned_frame.h"
#include "core/local/graph_geometry.h"
#include "core/local/jet_estimator.h"
#include "core/local/legendre_curve.h"
#include "core/local/noise.h"
#include "core/numerics/small_cholesky.h"

namespace palpate {
namespace {

constexpr int kDegree = 8;
constexpr int kTerms = kDegree + 1;
constexpr int kFirstPrior = 4;  ///< c_0 ... c_3 carry position, angle, kappa, kappa_s: free
constexpr int kFirstEvidence = 2;
using Fit = LegendreFit<kDegree>;
using Vector = LegendreVector<kTerms>;
using Matrix = Eigen::Matrix<double, kTerms, kTerms>;

/// (z_7^2 + z_8^2) / sigma^2 <= kAdequate: chi-square of two degrees of freedom, upper 1 %.
constexpr double kAdequate = 9.21;
/// half extent > kMinHalfExtentSigmas * sigma: shorter, and noise along the axis is no small
/// perturbation of the places of the samples.
constexpr double kMinHalfExtentSigmas = 10.0;
/// Shrinkage of a window that is not adequate or turns too far.
constexpr double kShrink = 0.8;
/// |slope| <= kMaxSlope over the window: 45 degrees.
constexpr double kMaxSlope = 1.0;

/// Grid of the prior: A in units of the size of c_2 and c_3, rho of the fall-off.
constexpr std::array<double, 5> kAmplitudes = {0.25, 0.5, 1.0, 2.0, 4.0};
constexpr std::array<double, 8> kFallOffs = {0.03, 0.06, 0.1, 0.15, 0.22, 0.32, 0.45, 0.6};
/// Grid points with less than this part of the evidence are left out of the average.
constexpr double kLeastEvidence = 1e-3;

struct Window {
  std::span<const Vec2> samples;
  AlignedFrame frame;
  Fit fit;
  double sigma = 0.0;  ///< in units of the frame
};

std::span<const Vec2> window_at(std::span<const Vec2> patch, PatchPlace place, std::size_t count) {
  switch (place) {
    case PatchPlace::Start:
      return patch.first(count);
    case PatchPlace::End:
      return patch.last(count);
    case PatchPlace::Centre:
      break;
  }
  return patch.subspan((patch.size() - count) / 2, count);
}

/// Ok, or why this window is none for the polynomial; whether the polynomial explains it is another
/// question.
LocalStatus fit_window(std::span<const Vec2> samples, double sigma_m, Window& window) {
  const auto [status, frame] = aligned_frame(samples);
  if (status != LocalStatus::Ok) {
    return status;
  }
  window.samples = samples;
  window.frame = frame;
  window.sigma = sigma_m / frame.half_extent_m;
  if (const LocalStatus order = check_backtrack(frame, window.sigma, 0.0);
      order != LocalStatus::Ok) {
    return order;
  }
  if (kMinHalfExtentSigmas * window.sigma >= 1.0) {
    return LocalStatus::Unresolved;
  }
  Fit plain;
  for (const Vec2& p : samples) {
    const Vec2 uv = frame.to_frame(p);
    plain.add(uv.x(), uv.y(), 1.0);
  }
  if (!plain.factorise(0.0)) {
    return LocalStatus::Unresolved;
  }
  // The tangent's slope from the quartic: the full polynomial's own swings with the noise.
  const LegendreVector<5> smooth = plain.coefficients<4>();
  window.fit = Fit();
  for (const Vec2& p : samples) {
    const Vec2 uv = frame.to_frame(p);
    const double s = slope<5>(smooth, uv.x());
    if (std::abs(s) > kMaxSlope) {
      return LocalStatus::TurnsTooFar;
    }
    window.fit.add(uv.x(), uv.y(), 1.0 / (1.0 + s * s));
  }
  if (!window.fit.factorise(0.0)) {
    return LocalStatus::Unresolved;
  }
  return LocalStatus::Ok;
}

bool is_explained(const Window& window) {
  const double highest = window.fit.scores().tail<2>().squaredNorm();
  const double rounding =
      std::pow(window.frame.rounding, 2) * static_cast<double>(window.samples.size());
  return highest <= kAdequate * window.sigma * window.sigma + rounding;
}

/// Standard deviations of c_4 ... c_8 under one point of the prior's grid, and its evidence.
struct Prior {
  Vector sd;
  double evidence = 0.0;
};
using Priors = std::array<Prior, kAmplitudes.size() * kFallOffs.size()>;

/// `c`: the free fit, `variance`: of its coefficients (correlations left out of the evidence).
Priors weigh_priors(const Vector& c, const Vector& variance) {
  const double size = std::sqrt(c[2] * c[2] + c[3] * c[3] + variance[2] + variance[3]) +
                      std::numeric_limits<double>::min();
  Priors priors;
  double best = -std::numeric_limits<double>::infinity();
  std::size_t i = 0;
  for (const double amplitude : kAmplitudes) {
    for (const double fall_off : kFallOffs) {
      Prior& prior = priors[i++];
      for (int k = kFirstEvidence; k < kTerms; ++k) {
        prior.sd[k] = amplitude * size * std::pow(fall_off, k - kFirstEvidence);
        const double total = prior.sd[k] * prior.sd[k] + variance[k];
        prior.evidence -= 0.5 * (std::log(total) + c[k] * c[k] / total);
      }
      best = std::max(best, prior.evidence);
    }
  }
  double sum = 0.0;
  for (Prior& prior : priors) {
    prior.evidence = std::exp(prior.evidence - best);
    sum += prior.evidence;
  }
  for (Prior& prior : priors) {
    prior.evidence /= sum;
  }
  return priors;
}

struct Posterior {
  Vector mean = Vector::Zero();
  Matrix covariance = Matrix::Zero();
};

Posterior average(const Window& window) {
  const Matrix& lower = window.fit.factor();
  const Matrix& normal = window.fit.normal();
  const Vector& moments = window.fit.moments();
  const double noise = window.sigma * window.sigma;
  const Matrix inverse_factor = inverse_lower(lower);
  const Vector variance = noise * inverse_factor.colwise().squaredNorm().transpose();
  const Priors priors = weigh_priors(window.fit.coefficients(), variance);

  Posterior posterior;
  Matrix squares = Matrix::Zero();
  double total = 0.0;
  for (const Prior& prior : priors) {
    if (prior.evidence < kLeastEvidence) {
      continue;
    }
    Matrix precision = normal;
    for (int k = kFirstPrior; k < kTerms; ++k) {
      precision(k, k) += noise / (prior.sd[k] * prior.sd[k]);
    }
    Matrix factor;
    cholesky(precision, &factor);
    const Vector c = solve_cholesky(factor, moments);
    posterior.mean += prior.evidence * c;
    squares += prior.evidence * c * c.transpose();
    posterior.covariance += prior.evidence * noise * inverse_cholesky(factor);
    total += prior.evidence;
  }
  posterior.mean /= total;
  posterior.covariance /= total;
  posterior.covariance += squares / total - posterior.mean * posterior.mean.transpose();
  return posterior;
}

LocalResult estimate_at(const Window& window, double u, double sigma_m) {
  const Posterior posterior = average(window);
  const AlignedFrame& frame = window.frame;
  const double unit = frame.half_extent_m;
  const Eigen::Matrix<double, 5, kTerms> basis = legendre_derivatives<5, kTerms>(u);
  const Eigen::Matrix<double, 5, 1> derivatives = basis * posterior.mean;
  const GraphGeometry geometry = graph_geometry(derivatives);
  const Eigen::Vector4d units(unit, 1.0, 1.0 / unit, 1.0 / (unit * unit));
  const Eigen::Matrix<double, 4, kTerms> rows = units.asDiagonal() * (geometry.jacobian * basis);
  LocalResult result;
  LocalEstimate& e = result.estimate;
  e.position = frame.to_world({u, derivatives[0]});
  e.tangent_angle = wrap_angle(std::atan2(frame.axis.y(), frame.axis.x()) + geometry.angle);
  e.kappa = geometry.kappa / unit;
  e.kappa_s = geometry.kappa_s / (unit * unit);
  e.covariance = rows * posterior.covariance * rows.transpose();
  e.window_arc_m = unit * arc_length<kTerms>(posterior.mean, frame.first_u, frame.last_u);
  e.window_samples = static_cast<int>(window.samples.size());
  e.sigma_m = sigma_m;
  result.status = LocalStatus::Ok;
  if (!(e.position.allFinite() && std::isfinite(e.kappa) && std::isfinite(e.kappa_s) &&
        e.covariance.allFinite() && std::isfinite(e.window_arc_m))) {
    result = {LocalStatus::NotFinite, {}};
  }
  return result;
}

}  // namespace

AdaptiveJet adaptive_jet(std::span<const Vec2> patch, PatchPlace place, double sigma_m) {
  AdaptiveJet answer;
  const double u = place == PatchPlace::Start ? -1.0 : place == PatchPlace::End ? 1.0 : 0.0;
  if (patch.size() < kAdaptiveSamples) {
    answer.samples = patch.size();
    answer.result = jet_estimate(patch, {.sigma_m = sigma_m, .place = u});
    return answer;
  }
  if (!(sigma_m > 0.0)) {
    const NoiseEstimate noise = estimate_noise(patch);
    if (noise.status != LocalStatus::Ok) {
      answer.result.status = noise.status;
      return answer;
    }
    sigma_m = noise.sigma_m;
  }
  // The longest window that the polynomial explains, else the shortest that it could be fitted to.
  Window window;
  Window fitted;
  bool found = false;
  for (std::size_t count = patch.size(); count >= kAdaptiveSamples;
       count = static_cast<std::size_t>(kShrink * static_cast<double>(count))) {
    answer.result.status = fit_window(window_at(patch, place, count), sigma_m, window);
    if (answer.result.status == LocalStatus::Ok) {
      fitted = window;
      found = true;
      if (is_explained(window)) {
        break;
      }
    }
  }
  if (found) {
    answer.first_sample = static_cast<std::size_t>(fitted.samples.data() - patch.data());
    answer.samples = fitted.samples.size();
    answer.result = estimate_at(fitted, u, sigma_m);
  }
  return answer;
}

std::array<AdaptiveJet, 3> patch_estimates(std::span<const Vec2> patch, double sigma_m) {
  if (!(sigma_m > 0.0)) {
    sigma_m = estimate_noise(patch).sigma_m;
  }
  return {adaptive_jet(patch, PatchPlace::Start, sigma_m),
          adaptive_jet(patch, PatchPlace::Centre, sigma_m),
          adaptive_jet(patch, PatchPlace::End, sigma_m)};
}

}  // namespace palpate
