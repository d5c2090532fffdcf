#include "core/local/stream/window_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "core/local/aligned_frame.h"
#include "core/local/graph_geometry.h"
#include "core/local/legendre_curve.h"
#include "core/local/stream/higher_terms.h"
#include "core/local/stream/straightening.h"
#include "core/local/stream/window_columns.h"
#include "core/numerics/matrices/small_cholesky.h"
#include "core/numerics/polynomials/legendre_fit.h"

namespace palpate {
namespace {

constexpr int kSize = kWindowSize;
constexpr int kAllTerms = kSize + kTailTerms;
using Fit = LegendreFit<kWindowDegree>;
using Vector = LegendreVector<kSize>;
using Matrix = Eigen::Matrix<double, kSize, kSize>;
/// Several right-hand sides, one per column.
template <int Columns>
using Sides = Eigen::Matrix<double, kSize, Columns, Eigen::RowMajor>;

/// Upper 1e-4 point of chi-square with two degrees of freedom, for the squares of the two highest
/// orthonormal terms. Every estimate makes this test, 400 times along a stroke of 1,600 samples. A
/// window that chance has shortened must grow again, and until then kappa_s is worse by the power
/// 3.5 of its length; this happens in one of 25 such strokes. The upper 1 % point would shorten
/// windows four times per stroke, and the other windows only by the sixteenth root of the ratio of
/// the two thresholds, 4 %.
constexpr double kAdequate = 18.42;
/// The same for all five terms beyond the third, in a straightened window.
constexpr double kCircular = 25.74;
/// half extent > kMinHalfExtentSigmas * sigma: in a shorter window noise along the axis is not a
/// small perturbation of the places of the samples.
constexpr double kMinHalfExtentSigmas = 10.0;
/// rounding < kMostRounding, of the half extent: above it, rounding alone determines the axis.
constexpr double kMostRounding = 1.0 / 16.0;
/// |slope| <= kMaxSlope over the window: 45 degrees.
constexpr double kMaxSlope = 1.0;
/// Windows that turn farther from their middle are straightened.
constexpr double kMostTurnOfAGraph = 0.25 * kPi;
/// If a window turns by less, the polynomial fits a circle to 1e-9 of the radius, and straightening
/// changes nothing: its term of degree 8 is 5 / 128 of the 8th power of (half extent / radius),
/// divided by 50 in Legendre's basis.
constexpr double kLeastTurn = 0.2;
/// cos^2(phi / 2) >= kLeastShrink, where phi is the turn of the window from its middle: at most 120
/// degrees to either side. Beyond, samples would count less than a sixteenth.
constexpr double kLeastShrink = 0.25;

double squared(double x) { return x * x; }

/// Rounding of the coordinates of the nodes. [m]
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

/// How a window is to be fitted.
struct Asked {
  bool is_circular = false;  ///< accept only a path that is a circle up to kappa_s and noise
  double noise_m = 0.0;      ///< of a sample
  double form_deviation_m = 0.0;
  bool may_enlarge_noise = false;  ///< where the polynomial does not follow
};

/// A window in its frame.
struct PlacedWindow {
  explicit PlacedWindow(std::size_t nodes) : columns(nodes) {}

  WindowColumns columns;
  AlignedFrame frame;
  double node_noise = 0.0;  ///< of an average node [half extent]
  double variance = 0.0;    ///< of an average node, smooth form deviation counted [half extent^2]
};

/// Straightens the nodes, finds their frame and weighs them. Ok, or why the window has no fit.
LocalStatus place(const Straightening& straight, std::span<const PathNode> nodes,
                  const Asked& asked, PlacedWindow* window) {
  const std::span<Vec2> positions = window->columns.positions;
  const std::span<double> weights = window->columns.weight;
  double samples_weight = 0.0;
  double weight_sum = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Straightening::Point point = straight.to_line(nodes[i].position_m);
    if (point.shrink < kLeastShrink) {
      return LocalStatus::TurnsTooFar;
    }
    positions[i] = point.w_m;
    weights[i] = nodes[i].weight * squared(point.shrink);
    samples_weight += nodes[i].weight;
    weight_sum += weights[i];
  }
  auto [status, frame] = aligned_frame(positions);
  if (status != LocalStatus::Ok) {
    return status;
  }
  const double unit = frame.half_extent_m;
  // Of the original coordinates: those of the frame are measured from the window's middle.
  frame.rounding = std::max(frame.rounding, rounding_of(nodes) / unit);
  if (frame.rounding >= kMostRounding) {
    return LocalStatus::NoExtent;
  }
  // It bounds how far nodes may run back.
  const double mean_weight = weight_sum / static_cast<double>(nodes.size());
  window->node_noise = std::max(asked.noise_m / std::sqrt(mean_weight) / unit, frame.rounding);
  status = check_backtrack(frame, 2.0 * window->node_noise, 0.0);
  if (status != LocalStatus::Ok) {
    return status;
  }
  if (kMinHalfExtentSigmas * window->node_noise >= 1.0) {
    return LocalStatus::Unresolved;
  }
  // Form error that is smooth along the arc adds at most this to any combination of the residuals.
  const double precision = samples_weight / std::max(squared(asked.noise_m),
                                                     squared(frame.rounding * unit) * mean_weight);
  const double coherent = 1.0 + squared(asked.form_deviation_m) * precision;
  window->variance = squared(window->node_noise) * coherent;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Vec2 uv = frame.to_frame(positions[i]);
    window->columns.u[i] = uv.x();
    window->columns.v[i] = uv.y();
    weights[i] /= mean_weight;
  }
  window->columns.close();
  window->frame = frame;
  return LocalStatus::Ok;
}

/// The sums from which a window's polynomial follows.
using Sums = LegendreSums<2 * kWindowDegree + 1 + kTailTerms, kSize>;

/// Weighs the nodes by the slope of the path, which a quartic gives: that of the full polynomial
/// varies with the noise. Ok, or why the window has no fit.
LocalStatus weigh_by_slope(const Asked& asked, PlacedWindow* window) {
  WindowColumns& columns = window->columns;
  LegendreFit<4> smooth(LegendreSums<9, 5>(columns.u, columns.v, columns.weight));
  if (!smooth.factorise(0.0)) {
    return LocalStatus::Unresolved;
  }
  // Most windows that are not a circle show it here, at a third of the cost.
  const bool is_bent =
      asked.is_circular && squared(smooth.scores()[4]) > kCircular * squared(window->node_noise);
  return is_bent || columns.weigh_by_slope(smooth.coefficients()) > kMaxSlope
             ? LocalStatus::TurnsTooFar
             : LocalStatus::Ok;
}

/// Whether the polynomial follows the path: what its highest terms leave is noise. Where they may,
/// they enlarge the noise. Ok, or why the window has no fit.
LocalStatus follow(const Fit& fit, const Asked& asked, PlacedWindow* window) {
  const auto higher = fit.scores().tail<kSize - kFirstPrior>();
  if (asked.is_circular && higher.squaredNorm() > kCircular * squared(window->node_noise)) {
    return LocalStatus::TurnsTooFar;
  }
  const double highest = fit.scores().tail<2>().squaredNorm();
  if (highest > kAdequate * window->variance) {
    if (!asked.may_enlarge_noise) {
      return LocalStatus::NotFollowed;
    }
    window->variance = 0.5 * highest;  // the mean square of the two terms
  }
  return LocalStatus::Ok;
}

/// What the data say about the higher terms of the polynomial `free`.
HigherTerms prior_of(const Fit& fit, const Vector& free, double variance_of_unit) {
  Sides<kSize - 1> units_but_first = Sides<kSize - 1>::Zero();
  units_but_first.bottomRows<kSize - 1>().setIdentity();
  solve_lower_rows(fit.factor(), &units_but_first);
  Vector variance = Vector::Zero();  // that of c_0 is not needed
  variance.tail<kSize - 1>() =
      variance_of_unit * units_but_first.colwise().squaredNorm().transpose();
  return higher_terms(free, variance);
}

/// A polynomial under a prior of its higher terms.
struct ShrunkFit {
  Vector coefficients;
  Eigen::Matrix<double, 5, 1> derivatives;  ///< 0 ... 4 at the middle
  Eigen::Matrix<double, 5, 5> covariance;   ///< of the derivatives
};

/// nullopt if rounding leaves no factor.
std::optional<ShrunkFit> shrunk(const Fit& fit, const Sums& sums, double variance_of_unit) {
  const Vector free = fit.coefficients();
  const HigherTerms prior = prior_of(fit, free, variance_of_unit);
  Matrix information = fit.normal();
  information.diagonal().tail<kPriorTerms>().array() += variance_of_unit / prior.variances.array();
  Matrix factor;
  if (!cholesky(information, &factor)) {
    return std::nullopt;
  }
  // Columns, multiplied by L^-1 (L is the factor): the gradients of v and its derivatives at the
  // middle, the products with the terms that the polynomial lacks, and the moments. All results of
  // the fit are products of these columns.
  const auto& basis = basis_at_middle();
  const auto inner = basis.leftCols<kSize>();
  constexpr int kLacking = 5;
  constexpr int kMoments = kLacking + kTailTerms;
  Sides<kMoments + 1> white;
  white.leftCols<kLacking>() = inner.transpose();
  white.middleCols<kTailTerms>(kLacking) = sums.products<kSize, kTailTerms, kSize>();
  white.col(kMoments) = fit.moments();
  solve_lower_rows(factor, &white);
  const Eigen::Matrix<double, 5, kMoments + 1, Eigen::RowMajor> products =
      white.leftCols<kLacking>().transpose().lazyProduct(white);
  ShrunkFit result;
  result.coefficients = solve_lower_transposed<kSize>(factor, Vector(white.col(kMoments)));
  result.derivatives = products.col(kMoments);
  result.covariance = variance_of_unit * products.leftCols<kLacking>();
  // A term that the polynomial lacks goes partly into the terms that it has, because few samples
  // cannot distinguish them.
  for (int k = 0; k < kTailTerms; ++k) {
    const Eigen::Matrix<double, 5, 1> missing = basis.col(kSize + k) - products.col(kLacking + k);
    result.covariance += prior.tail_variances[k] * missing * missing.transpose();
  }
  // The grid points differ in how much of each term they keep.
  const Eigen::Matrix<double, 5, kPriorTerms> terms =
      inner.rightCols<kPriorTerms>() * free.tail<kPriorTerms>().asDiagonal();
  result.covariance += terms.lazyProduct(prior.apart).eval().lazyProduct(terms.transpose());
  return result;
}

/// What a polynomial tells of the path at the middle of its window.
LocalEstimate estimate_of(const ShrunkFit& fit, const AlignedFrame& frame,
                          const Straightening& straight, double noise_m) {
  const double unit = frame.half_extent_m;
  // The abscissa along the straightened circle.
  const auto abscissa_at = [&](double u) { return frame.to_world({u, 0.0}).x(); };
  const GraphGeometry geometry = graph_geometry(fit.derivatives);
  LocalEstimate e;
  e.position = frame.to_world({0.0, fit.derivatives[0]});
  e.tangent_angle = wrap_angle(std::atan2(frame.axis.y(), frame.axis.x()) + geometry.angle);
  e.kappa = geometry.kappa / unit;
  e.kappa_s = geometry.kappa_s / (unit * unit);
  const Eigen::Vector4d units(unit, 1.0, 1.0 / unit, 1.0 / (unit * unit));
  const Eigen::Matrix<double, 4, 5> rows = units.asDiagonal() * geometry.jacobian;
  e.covariance = rows.lazyProduct(fit.covariance).eval().lazyProduct(rows.transpose());
  const double length = arc_length<kSize>(fit.coefficients, frame.first_u, frame.last_u);
  const double longer = length / (frame.last_u - frame.first_u);
  e.window_arc_m = longer * straight.arc_m(abscissa_at(frame.first_u), abscissa_at(frame.last_u));
  e.sigma_m = noise_m;
  return straight.to_world(e);
}

/// The estimate in the middle of a window that is straightened so.
LocalResult fit_in(const Straightening& straight, std::span<const PathNode> nodes,
                   const Asked& asked) {
  PlacedWindow window(nodes.size());
  const auto without_fit = [](LocalStatus status) { return LocalResult{status, {}}; };
  if (const LocalStatus status = place(straight, nodes, asked, &window);
      status != LocalStatus::Ok) {
    return without_fit(status);
  }
  if (const LocalStatus status = weigh_by_slope(asked, &window); status != LocalStatus::Ok) {
    return without_fit(status);
  }
  const Sums sums(window.columns.u, window.columns.v, window.columns.weight);
  Fit fit(sums);
  if (!fit.factorise(0.0)) {
    return without_fit(LocalStatus::Unresolved);
  }
  if (const LocalStatus status = follow(fit, asked, &window); status != LocalStatus::Ok) {
    return without_fit(status);
  }
  const auto found = shrunk(fit, sums, window.variance);
  if (!found) {
    return without_fit(LocalStatus::Unresolved);
  }
  const LocalEstimate estimate = estimate_of(*found, window.frame, straight, asked.noise_m);
  return is_finite(estimate) ? LocalResult{LocalStatus::Ok, estimate}
                             : without_fit(LocalStatus::NotFinite);
}

}  // namespace

LocalResult fit_window(std::span<const PathNode> nodes, double noise, double form_deviation_m,
                       bool may_enlarge_noise) {
  if (nodes.size() < kFewestWindowNodes) {
    return {};
  }
  const Straightening straight(nodes);
  const auto graph_of = [&] {
    return fit_in(straight.left_bent(), nodes, {false, noise, form_deviation_m, may_enlarge_noise});
  };
  // Form deviation hides whether the path is a circle. Such windows are as long as a graph allows.
  if (form_deviation_m > 0.0) {
    return graph_of();
  }
  const auto straightened = [&] { return fit_in(straight, nodes, {true, noise, 0.0, false}); };
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
