#include "core/local/stream/window_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/local/graph_geometry.h"
#include "core/local/legendre_curve.h"
#include "core/numerics/legendre_fit.h"
#include "core/numerics/small_cholesky.h"

namespace palpate {
namespace {

constexpr int kDegree = 8;
constexpr int kSize = kDegree + 1;
constexpr int kFirstPrior = 4;  ///< c_0 ... c_3 carry position, angle, kappa, kappa_s: free
constexpr int kFirstEvidence = 2;
/// Terms beyond the polynomial that the covariance knows of: an odd one for kappa_s and an even one
/// for kappa.
constexpr int kTail = 2;
constexpr int kAllTerms = kSize + kTail;
using Fit = LegendreFit<kDegree>;
using Vector = LegendreVector<kSize>;
using Matrix = Eigen::Matrix<double, kSize, kSize>;
using Deviations = std::array<double, kAllTerms>;

/// Squares of the two highest orthonormal terms, chi-square of two degrees of freedom.
constexpr double kAdequate = 9.21;  ///< its upper 1 %
/// half extent > kMinHalfExtentSigmas * sigma: shorter, and noise along the axis is no small
/// perturbation of the places of the samples.
constexpr double kMinHalfExtentSigmas = 10.0;
/// |slope| <= kMaxSlope over the window: 45 degrees.
constexpr double kMaxSlope = 1.0;

/// Grid of the prior: A in units of the size of c_2 and c_3, rho of the fall-off.
constexpr std::array<double, 4> kAmplitudes = {0.125, 0.25, 0.5, 1.0};
constexpr std::array<double, 10> kFallOffs = {0.012, 0.021, 0.036, 0.06, 0.1,
                                              0.15,  0.22,  0.3,   0.45, 0.65};
/// What speaks for a fall-off before the window's terms do. Windows end where the highest terms are
/// noise, so that slower ones than 0.3 are the exception: beside bends, about one window in a
/// hundred.
constexpr std::array<double, 10> kPriorOdds = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.01, 0.01};

/// Prior standard deviations of the terms from kFirstPrior on: mean squares over the grid, weighed
/// by the evidence of the free fit's terms (their correlations left out).
Deviations prior_deviations(const Vector& c, const Vector& variance) {
  const double size = std::sqrt(c[2] * c[2] + c[3] * c[3] + variance[2] + variance[3]) +
                      std::numeric_limits<double>::min();
  Vector squares = c.cwiseAbs2();
  std::array<double, kAmplitudes.size() * kFallOffs.size()> evidence{};
  double best = -std::numeric_limits<double>::infinity();
  std::size_t i = 0;
  for (const double amplitude : kAmplitudes) {
    for (std::size_t j = 0; j < kFallOffs.size(); ++j) {
      const double fall_off = kFallOffs[j];
      double sd2 = amplitude * size * amplitude * size;
      double sum = 0.0;
      double product = 1.0 / (kPriorOdds[j] * kPriorOdds[j]);
      for (int k = kFirstEvidence; k < kSize; ++k) {
        const double total = sd2 + variance[k];
        // Relative to the first term's, so that the product stays a number.
        product *= total / (size * size);
        sum += squares[k] / total;
        sd2 *= fall_off * fall_off;
      }
      evidence[i] = -0.5 * (std::log(product) + sum);
      best = std::max(best, evidence[i]);
      ++i;
    }
  }
  Deviations squares_of{};
  double total = 0.0;
  i = 0;
  for (const double amplitude : kAmplitudes) {
    for (const double fall_off : kFallOffs) {
      const double share = std::exp(evidence[i++] - best);
      total += share;
      double sd2 = share * amplitude * amplitude * size * size;
      for (int k = kFirstEvidence; k < kAllTerms; ++k) {
        squares_of[static_cast<std::size_t>(k)] += sd2;
        sd2 *= fall_off * fall_off;
      }
    }
  }
  for (double& square : squares_of) {
    square = std::sqrt(square / total);
  }
  return squares_of;
}

/// Derivatives 0 ... 4 at u = 0 of P_0 ... P_10.
const Eigen::Matrix<double, 5, kAllTerms>& basis_at_middle() {
  static const Eigen::Matrix<double, 5, kAllTerms> basis = legendre_derivatives<5, kAllTerms>(0.0);
  return basis;
}

double squared(double x) { return x * x; }

}  // namespace

LocalResult fit_window(std::span<const PathNode> nodes, double noise, double form_deviation_m,
                       bool may_enlarge_noise) {
  LocalResult result;
  if (nodes.size() < kFewestWindowNodes) {
    return result;
  }
  // Nothing is allocated for a pyramid's window.
  std::array<Vec2, 2 * NodePyramid::kMostNodes> few;
  std::vector<Vec2> many(nodes.size() > NodePyramid::kMostNodes ? 2 * nodes.size() : 0);
  const std::span<Vec2> room = many.empty() ? std::span<Vec2>(few) : std::span<Vec2>(many);
  const std::span<Vec2> positions = room.first(nodes.size());
  const std::span<Vec2> uv = room.subspan(nodes.size(), nodes.size());
  double weight_sum = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    positions[i] = nodes[i].position_m;
    weight_sum += nodes[i].weight;
  }
  const auto [status, frame] = aligned_frame(positions);
  if (status != LocalStatus::Ok) {
    result.status = status;
    return result;
  }
  const double unit = frame.half_extent_m;
  // Noise of the lightest node, which may run back the farthest.
  const double mean_weight = weight_sum / static_cast<double>(nodes.size());
  const double node_noise = std::max(noise / std::sqrt(mean_weight) / unit, frame.rounding);
  result.status = check_backtrack(frame, 2.0 * node_noise, 0.0);
  if (result.status != LocalStatus::Ok) {
    return result;
  }
  result.status = LocalStatus::Unresolved;
  if (kMinHalfExtentSigmas * node_noise >= 1.0) {
    return result;
  }
  LegendreFit<4> smooth;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    uv[i] = frame.to_frame(positions[i]);
    smooth.add(uv[i].x(), uv[i].y(), nodes[i].weight / mean_weight);
  }
  if (!smooth.factorise(0.0)) {
    return result;
  }
  // The tangent's slope from the quartic: the full polynomial's own swings with the noise.
  const LegendreVector<5> quartic = smooth.coefficients();
  Fit fit;
  Eigen::Matrix<double, kSize, kTail> overlap = Eigen::Matrix<double, kSize, kTail>::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double s = slope<5>(quartic, uv[i].x());
    if (std::abs(s) > kMaxSlope) {
      result.status = LocalStatus::TurnsTooFar;
      return result;
    }
    const double weight = nodes[i].weight / mean_weight / (1.0 + s * s);
    fit.add(uv[i].x(), uv[i].y(), weight);
    const LegendreVector<kAllTerms> p = legendre<kAllTerms>(uv[i].x());
    overlap += weight * p.head<kSize>() * p.tail<kTail>().transpose();
  }
  if (!fit.factorise(0.0)) {
    return result;
  }
  // Form error that is smooth along the arc adds at most this to any combination of the residuals.
  const double precision =
      weight_sum / std::max(squared(noise), squared(frame.rounding * unit) * mean_weight);
  const double coherent = 1.0 + squared(form_deviation_m) * precision;
  double variance_of_unit = squared(node_noise) * coherent;
  const double highest = fit.scores().tail<2>().squaredNorm();
  if (highest > kAdequate * variance_of_unit) {
    if (!may_enlarge_noise) {
      result.status = LocalStatus::NotFollowed;
      return result;
    }
    variance_of_unit = 0.5 * highest;  // the mean square of two
  }

  const Matrix inverse_factor = inverse_lower(fit.factor());
  const Vector variance = variance_of_unit * inverse_factor.colwise().squaredNorm().transpose();
  const Deviations prior = prior_deviations(fit.coefficients(), variance);
  Matrix information = fit.normal();
  for (int k = kFirstPrior; k < kSize; ++k) {
    information(k, k) += variance_of_unit / squared(prior[static_cast<std::size_t>(k)]);
  }
  Matrix factor;
  if (!cholesky(information, &factor)) {
    return result;
  }
  const Vector c = solve_cholesky(factor, fit.moments());

  const auto& basis = basis_at_middle();
  const Eigen::Matrix<double, 5, 1> derivatives = basis.leftCols<kSize>() * c;
  const GraphGeometry geometry = graph_geometry(derivatives);
  const Eigen::Vector4d units(unit, 1.0, 1.0 / unit, 1.0 / (unit * unit));
  const Eigen::Matrix<double, 4, kAllTerms> rows = units.asDiagonal() * (geometry.jacobian * basis);
  LocalEstimate& e = result.estimate;
  e.position = frame.to_world({0.0, derivatives[0]});
  e.tangent_angle = wrap_angle(std::atan2(frame.axis.y(), frame.axis.x()) + geometry.angle);
  e.kappa = geometry.kappa / unit;
  e.kappa_s = geometry.kappa_s / (unit * unit);
  const Eigen::Matrix<double, 4, kSize> inner = rows.leftCols<kSize>();
  e.covariance = variance_of_unit * inner * inverse_cholesky(factor) * inner.transpose();
  // A term that the polynomial lacks goes partly into those that it has: few samples cannot tell
  // them apart.
  for (int k = 0; k < kTail; ++k) {
    const Vector taken = solve_cholesky<kSize>(factor, overlap.col(k));
    const Eigen::Vector4d missing = rows.col(kSize + k) - inner * taken;
    e.covariance +=
        squared(prior[static_cast<std::size_t>(kSize + k)]) * missing * missing.transpose();
  }
  e.window_arc_m = unit * arc_length<kSize>(c, frame.first_u, frame.last_u);
  e.sigma_m = noise;
  result.status = LocalStatus::Ok;
  if (!(e.position.allFinite() && std::isfinite(e.kappa) && std::isfinite(e.kappa_s) &&
        e.covariance.allFinite() && std::isfinite(e.window_arc_m))) {
    result = {LocalStatus::NotFinite, {}};
  }
  return result;
}

}  // namespace palpate
