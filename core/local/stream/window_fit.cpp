#include "core/local/stream/window_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/local/graph_geometry.h"
#include "core/local/legendre_curve.h"
#include "core/local/stream/straightening.h"
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

/// Squares of the two highest orthonormal terms, chi-square of two degrees of freedom: its upper
/// 1e-4. A window is asked at every estimate, 400 times along a stroke of 1,600 samples, and what
/// chance has cut it must grow again, kappa_s worse by the power 3.5 of its length meanwhile: one
/// in 25 such strokes is cut. The upper 1 % would cut four times a stroke, and would make windows
/// shorter by the sixteenth root of the two thresholds' ratio, 4 %, only.
constexpr double kAdequate = 18.42;
/// The same of all five terms beyond the third, where the window is straightened.
constexpr double kCircular = 25.74;
/// half extent > kMinHalfExtentSigmas * sigma: shorter, and noise along the axis is no small
/// perturbation of the places of the samples.
constexpr double kMinHalfExtentSigmas = 10.0;
/// rounding < kMostRounding, of the half extent: else rounding alone decides the axis.
constexpr double kMostRounding = 1.0 / 16.0;
/// |slope| <= kMaxSlope over the window: 45 degrees.
constexpr double kMaxSlope = 1.0;
/// Windows that turn farther from their middle are straightened.
constexpr double kMostTurnOfAGraph = 0.25 * kPi;
/// Of less the polynomial takes a circle for one to 1e-9 of the radius, and straightening changes
/// nothing: its term of degree 8 is 5 / 128 of the 8th power of the half extent over the radius,
/// over 50 in Legendre's basis.
constexpr double kLeastTurn = 0.2;
/// cos^2(phi / 2) >= kLeastShrink, phi what the window turns by from its middle: 120 degrees to
/// either side. Beyond, samples count less than a sixteenth.
constexpr double kLeastShrink = 0.25;

double squared(double x) { return x * x; }

/// Grid of the prior: A in units of the size of c_2 and c_3, rho of the fall-off. Where noise makes
/// up that size, the terms may be much smaller.
constexpr std::array<double, 3> kAmplitudes = {0.0625, 0.25, 1.0};
constexpr std::array<double, 10> kFallOffs = {0.012, 0.021, 0.036, 0.06, 0.1,
                                              0.15,  0.22,  0.3,   0.45, 0.65};
/// What speaks for a fall-off before the window's terms do. Windows end where the highest terms are
/// noise, so that slower ones than 0.3 are the exception: beside bends, about one window in a
/// hundred.
constexpr std::array<double, 10> kPriorOdds = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.01, 0.01};
/// Odd terms over even ones, squared: anywhere on a curve, near a place where it is its own mirror
/// image, and at one. A circle is everywhere, and its odd terms, which vanish, say nothing of its
/// even ones.
constexpr std::array<double, 3> kOdd2 = {1.0, 0.01, 0.0};

constexpr int kFallOffCount = static_cast<int>(kFallOffs.size());
constexpr int kPairs = static_cast<int>(kAmplitudes.size()) * kFallOffCount;
using Pairs = Eigen::Array<double, kPairs, 1>;

/// A^2, rho^2 and the odds of each point of the grid.
struct GridPoints {
  Pairs amplitude2, fall_off2, odds;
  GridPoints() {
    for (int i = 0; i < kPairs; ++i) {
      const auto fall_off = static_cast<std::size_t>(i % kFallOffCount);
      amplitude2[i] = squared(kAmplitudes[static_cast<std::size_t>(i / kFallOffCount)]);
      fall_off2[i] = squared(kFallOffs[fall_off]);
      odds[i] = kPriorOdds[fall_off];
    }
  }
};

/// The free fit's terms of one parity, at every point of the grid. A term of variance v and prior
/// variance s2 is kept by the share s2 / (s2 + v).
struct ParityTerms {
  std::array<Pairs, kSize> kept;
  std::array<Pairs, kSize> inverse;  ///< 1 / (s2 + v)
  Pairs exponent = Pairs::Zero();    ///< of the evidence, and what stands before it, squared
  Pairs factor2 = Pairs::Ones();

  ParityTerms(int first, const Vector& c, const Vector& variance, double size2, Pairs s2,
              const Pairs& fall_off4) {
    for (int k = first; k < kSize; k += 2) {
      const auto i = static_cast<std::size_t>(k);
      inverse[i] = (s2 + variance[k]).inverse();
      kept[i] = s2 * inverse[i];
      exponent += squared(c[k]) * inverse[i];
      factor2 *= size2 * inverse[i];  // relative to the size, so that the product stays a number
      s2 *= fall_off4;
    }
  }
};

/// What the data say of the terms from kFirstPrior on.
struct PriorMixture {
  /// Of the one prior that keeps as much of each term as the grid's points do in the mean.
  Eigen::Matrix<double, kAllTerms, 1> variances = Eigen::Matrix<double, kAllTerms, 1>::Zero();
  /// Covariance, over the grid, of the shares that its points keep.
  Matrix apart = Matrix::Zero();
};

/// The posterior over the grid by the evidence of the free fit's terms, their correlations left
/// out.
PriorMixture prior_mixture(const Vector& c, const Vector& variance) {
  static const GridPoints points;
  static const Pairs fall_off4 = points.fall_off2.square();
  static const Pairs fall_off8 = fall_off4.square();
  const double size2 =
      c[2] * c[2] + c[3] * c[3] + variance[2] + variance[3] + std::numeric_limits<double>::min();
  const Pairs second = size2 * points.amplitude2;
  const Pairs third = second * points.fall_off2;
  const ParityTerms even(kFirstEvidence, c, variance, size2, second, fall_off4);
  const auto odd_terms = [&](double odd2) {
    return ParityTerms(kFirstEvidence + 1, c, variance, size2, odd2 * third, fall_off4);
  };
  const std::array<ParityTerms, kOdd2.size()> odd = {odd_terms(kOdd2[0]), odd_terms(kOdd2[1]),
                                                     odd_terms(kOdd2[2])};
  double least = std::numeric_limits<double>::infinity();
  for (const ParityTerms& terms : odd) {
    least = std::min(least, (even.exponent + terms.exponent).minCoeff());
  }
  std::array<Pairs, kOdd2.size()> shares;
  Pairs pairs = Pairs::Zero();
  double total = 0.0;
  for (std::size_t i = 0; i < odd.size(); ++i) {
    shares[i] = points.odds * (even.factor2 * odd[i].factor2).sqrt() *
                (0.5 * (least - even.exponent - odd[i].exponent)).exp();
    pairs += shares[i];
    total += shares[i].sum();
  }
  PriorMixture mixture;
  Vector kept = Vector::Zero();
  for (int k = kFirstPrior; k < kSize; ++k) {
    const auto at = static_cast<std::size_t>(k);
    double inverse = 0.0;
    Pairs weighted = Pairs::Zero();  // what the points keep, times their shares
    if (k % 2 == 0) {
      weighted = pairs * even.kept[at];
      inverse = (pairs * even.inverse[at]).sum();
    }
    for (std::size_t i = 0; k % 2 == 1 && i < odd.size(); ++i) {
      weighted += shares[i] * odd[i].kept[at];
      inverse += (shares[i] * odd[i].inverse[at]).sum();
    }
    const double sum = weighted.sum();
    kept[k] = sum / total;
    mixture.variances[k] = sum / inverse;
    for (int j = kFirstPrior + k % 2; j <= k; j += 2) {
      const auto before = static_cast<std::size_t>(j);
      double both = 0.0;
      if (k % 2 == 0) {
        both = (weighted * even.kept[before]).sum();
      }
      for (std::size_t i = 0; k % 2 == 1 && i < odd.size(); ++i) {
        both += (shares[i] * odd[i].kept[at] * odd[i].kept[before]).sum();
      }
      mixture.apart(k, j) = both / total - kept[k] * kept[j];
    }
    if (k % 2 == 1) {
      for (int j = kFirstPrior; j < kSize; j += 2) {
        const double both = (weighted * even.kept[static_cast<std::size_t>(j)]).sum() / total;
        mixture.apart(std::max(j, k), std::min(j, k)) = both;
      }
    }
  }
  for (int k = kFirstPrior + 1; k < kSize; k += 2) {
    for (int j = kFirstPrior; j < kSize; j += 2) {
      mixture.apart(std::max(j, k), std::min(j, k)) -= kept[k] * kept[j];
    }
  }
  mixture.apart = mixture.apart.selfadjointView<Eigen::Lower>();
  // No sample says anything of the terms that the polynomial lacks but through A and rho.
  const Pairs ninth = third * fall_off4 * fall_off8;
  const Pairs odd_shares = kOdd2[0] * shares[0] + kOdd2[1] * shares[1] + kOdd2[2] * shares[2];
  mixture.variances[kSize] = (odd_shares * ninth).sum() / total;
  mixture.variances[kSize + 1] = (pairs * ninth * points.fall_off2).sum() / total;
  return mixture;
}

/// Of the coordinates of the nodes. [m]
double rounding_of(std::span<const PathNode> nodes) {
  return std::numeric_limits<double>::epsilon() *
         std::max(nodes.front().position_m.cwiseAbs().maxCoeff(),
                  nodes.back().position_m.cwiseAbs().maxCoeff());
}

/// Derivatives 0 ... 4 at u = 0 of P_0 ... P_10.
const Eigen::Matrix<double, 5, kAllTerms>& basis_at_middle() {
  static const Eigen::Matrix<double, 5, kAllTerms> basis = legendre_derivatives<5, kAllTerms>(0.0);
  return basis;
}

/// With `is_circular` only what is a circle but for kappa_s, to the noise: else TurnsTooFar.
LocalResult fit_in(const Straightening& straight, bool is_circular, std::span<const PathNode> nodes,
                   double noise, double form_deviation_m, bool may_enlarge_noise) {
  LocalResult result;
  // Nothing is allocated for a pyramid's window.
  std::array<Vec2, 2 * NodePyramid::kMostNodes> few;
  std::vector<Vec2> many(nodes.size() > NodePyramid::kMostNodes ? 2 * nodes.size() : 0);
  const std::span<Vec2> room = many.empty() ? std::span<Vec2>(few) : std::span<Vec2>(many);
  const std::span<Vec2> positions = room.first(nodes.size());
  const std::span<Vec2> uv = room.subspan(nodes.size(), nodes.size());
  std::array<double, NodePyramid::kMostNodes> few_weights;
  std::vector<double> many_weights(many.empty() ? 0 : nodes.size());
  const std::span<double> weights =
      many.empty() ? std::span<double>(few_weights) : std::span<double>(many_weights);
  double samples_weight = 0.0;
  double weight_sum = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Straightening::Point point = straight.to_line(nodes[i].position_m);
    if (point.shrink < kLeastShrink) {
      result.status = LocalStatus::TurnsTooFar;
      return result;
    }
    positions[i] = point.w_m;
    weights[i] = nodes[i].weight * squared(point.shrink);
    samples_weight += nodes[i].weight;
    weight_sum += weights[i];
  }
  auto [status, frame] = aligned_frame(positions);
  if (status != LocalStatus::Ok) {
    result.status = status;
    return result;
  }
  const double unit = frame.half_extent_m;
  // Of the coordinates as they came: those of the frame are counted from the window's middle.
  frame.rounding = std::max(frame.rounding, rounding_of(nodes) / unit);
  if (frame.rounding >= kMostRounding) {
    result.status = LocalStatus::NoExtent;
    return result;
  }
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
  // Form error that is smooth along the arc adds at most this to any combination of the residuals.
  const double precision =
      samples_weight / std::max(squared(noise), squared(frame.rounding * unit) * mean_weight);
  const double coherent = 1.0 + squared(form_deviation_m) * precision;
  double variance_of_unit = squared(node_noise) * coherent;
  LegendreFit<4> smooth;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    uv[i] = frame.to_frame(positions[i]);
    smooth.add(uv[i].x(), uv[i].y(), weights[i] / mean_weight);
  }
  if (!smooth.factorise(0.0)) {
    return result;
  }
  // Most windows that are no circle show it here, at a third of the cost.
  if (is_circular && squared(smooth.scores()[4]) > kCircular * squared(node_noise)) {
    result.status = LocalStatus::TurnsTooFar;
    return result;
  }
  // The tangent's slope from the quartic: the full polynomial's own swings with the noise.
  const LegendreVector<5> quartic = smooth.coefficients();
  Fit fit;
  Eigen::Matrix<double, kSize, kTail> overlap = Eigen::Matrix<double, kSize, kTail>::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const LegendreVector<kAllTerms> p = legendre<kAllTerms>(uv[i].x());
    const double s = slope_of<5, kAllTerms>(quartic, p);
    if (std::abs(s) > kMaxSlope) {
      result.status = LocalStatus::TurnsTooFar;
      return result;
    }
    const double weight = weights[i] / mean_weight / (1.0 + s * s);
    fit.add(p.head<kSize>(), uv[i].y(), weight);
    overlap += weight * p.head<kSize>() * p.tail<kTail>().transpose();
  }
  if (!fit.factorise(0.0)) {
    return result;
  }
  const auto higher = fit.scores().tail<kSize - kFirstPrior>();
  if (is_circular && higher.squaredNorm() > kCircular * squared(node_noise)) {
    result.status = LocalStatus::TurnsTooFar;
    return result;
  }
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
  const Vector free = fit.coefficients();
  const PriorMixture prior = prior_mixture(free, variance);
  Matrix information = fit.normal();
  for (int k = kFirstPrior; k < kSize; ++k) {
    information(k, k) += variance_of_unit / prior.variances[k];
  }
  Matrix factor;
  if (!cholesky(information, &factor)) {
    return result;
  }
  const Vector c = solve_cholesky(factor, fit.moments());

  // Of the frame, along the straightened circle.
  const auto abscissa_at = [&, frame = frame](double u) { return frame.to_world({u, 0.0}).x(); };
  const auto& basis = basis_at_middle();
  const Eigen::Matrix<double, 5, 1> derivatives = basis.leftCols<kSize>() * c;
  const GraphGeometry geometry = graph_geometry(derivatives);
  const Eigen::Vector4d units(unit, 1.0, 1.0 / unit, 1.0 / (unit * unit));
  const Eigen::Matrix<double, 4, kAllTerms> rows = units.asDiagonal() * (geometry.jacobian * basis);
  LocalEstimate e;
  e.position = frame.to_world({0.0, derivatives[0]});
  e.tangent_angle = wrap_angle(std::atan2(frame.axis.y(), frame.axis.x()) + geometry.angle);
  e.kappa = geometry.kappa / unit;
  e.kappa_s = geometry.kappa_s / (unit * unit);
  const Eigen::Matrix<double, 4, kSize> inner = rows.leftCols<kSize>();
  Eigen::Matrix<double, kSize, 4> whitened;
  for (int i = 0; i < 4; ++i) {
    whitened.col(i) = solve_lower<kSize>(factor, inner.row(i).transpose());
  }
  e.covariance = variance_of_unit * whitened.transpose().lazyProduct(whitened);
  // A term that the polynomial lacks goes partly into those that it has: few samples cannot tell
  // them apart.
  for (int k = 0; k < kTail; ++k) {
    const Vector taken = solve_cholesky<kSize>(factor, overlap.col(k));
    const Eigen::Vector4d missing = rows.col(kSize + k) - inner * taken;
    e.covariance += prior.variances[kSize + k] * missing * missing.transpose();
  }
  // The grid's points differ in how much of the terms they keep.
  const Eigen::Matrix<double, 4, kSize> terms = inner * free.asDiagonal();
  e.covariance += terms.lazyProduct(prior.apart).eval().lazyProduct(terms.transpose());
  const double length = arc_length<kSize>(c, frame.first_u, frame.last_u);
  const double longer = length / (frame.last_u - frame.first_u);
  e.window_arc_m = longer * straight.arc_m(abscissa_at(frame.first_u), abscissa_at(frame.last_u));
  e.sigma_m = noise;
  e = straight.to_world(e);
  result.estimate = e;
  result.status = LocalStatus::Ok;
  if (!(e.position.allFinite() && std::isfinite(e.kappa) && std::isfinite(e.kappa_s) &&
        e.covariance.allFinite() && std::isfinite(e.window_arc_m))) {
    result = {LocalStatus::NotFinite, {}};
  }
  return result;
}

}  // namespace

LocalResult fit_window(std::span<const PathNode> nodes, double noise, double form_deviation_m,
                       bool may_enlarge_noise) {
  if (nodes.size() < kFewestWindowNodes) {
    return {};
  }
  const Straightening straight(nodes);
  const auto graph_of = [&] {
    return fit_in(straight.left_bent(), false, nodes, noise, form_deviation_m, may_enlarge_noise);
  };
  // Form deviation hides whether the path is a circle: such windows are as long as a graph.
  if (form_deviation_m > 0.0) {
    return graph_of();
  }
  const auto straightened = [&] { return fit_in(straight, true, nodes, noise, 0.0, false); };
  if (straight.turns_beyond(kMostTurnOfAGraph)) {
    return straightened();
  }
  LocalResult graph = graph_of();
  if (graph.status == LocalStatus::NotFollowed && straight.turns_beyond(kLeastTurn)) {
    if (LocalResult circular = straightened()) {
      return circular;
    }
  }
  return graph;
}

}  // namespace palpate
