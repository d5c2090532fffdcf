#include "core/local/stream/window_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

/// With `is_circular`, accepts only a path that is a circle up to kappa_s and noise; otherwise
/// TurnsTooFar.
LocalResult fit_in(const Straightening& straight, bool is_circular, std::span<const PathNode> nodes,
                   double noise, double form_deviation_m, bool may_enlarge_noise) {
  LocalResult result;
  WindowColumns columns(nodes.size());
  const std::span<Vec2> positions = columns.positions;
  const std::span<double> weights = columns.weight;
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
  // Of the original coordinates: those of the frame are measured from the window's middle.
  frame.rounding = std::max(frame.rounding, rounding_of(nodes) / unit);
  if (frame.rounding >= kMostRounding) {
    result.status = LocalStatus::NoExtent;
    return result;
  }
  // Noise of an average node, which bounds how far nodes may run back.
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
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Vec2 uv = frame.to_frame(positions[i]);
    columns.u[i] = uv.x();
    columns.v[i] = uv.y();
    weights[i] /= mean_weight;
  }
  columns.close();
  LegendreFit<4> smooth(LegendreSums<9, 5>(columns.u, columns.v, columns.weight));
  if (!smooth.factorise(0.0)) {
    return result;
  }
  // Most windows that are not a circle show it here, at a third of the cost.
  if (is_circular && squared(smooth.scores()[4]) > kCircular * squared(node_noise)) {
    result.status = LocalStatus::TurnsTooFar;
    return result;
  }
  // The slope of the tangent comes from the quartic, because that of the full polynomial varies
  // with the noise.
  if (columns.weigh_by_slope(smooth.coefficients()) > kMaxSlope) {
    result.status = LocalStatus::TurnsTooFar;
    return result;
  }
  const LegendreSums<2 * kWindowDegree + 1 + kTailTerms, kSize> sums(columns.u, columns.v,
                                                                     columns.weight);
  Fit fit(sums);
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
    variance_of_unit = 0.5 * highest;  // the mean square of the two terms
  }

  Sides<kSize - 1> units_but_first = Sides<kSize - 1>::Zero();
  units_but_first.bottomRows<kSize - 1>().setIdentity();
  solve_lower_rows(fit.factor(), &units_but_first);
  Vector variance = Vector::Zero();  // that of c_0 is not needed
  variance.tail<kSize - 1>() =
      variance_of_unit * units_but_first.colwise().squaredNorm().transpose();
  const Vector free = fit.coefficients();
  const HigherTerms prior = higher_terms(free, variance);
  Matrix information = fit.normal();
  information.diagonal().tail<kPriorTerms>().array() += variance_of_unit / prior.variances.array();
  Matrix factor;
  if (!cholesky(information, &factor)) {
    return result;
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
  const Vector c = solve_lower_transposed<kSize>(factor, Vector(white.col(kMoments)));
  const Eigen::Matrix<double, 5, kMoments + 1, Eigen::RowMajor> products =
      white.leftCols<kLacking>().transpose().lazyProduct(white);

  // The abscissa along the straightened circle.
  const auto abscissa_at = [&, frame = frame](double u) { return frame.to_world({u, 0.0}).x(); };
  const Eigen::Matrix<double, 5, 1> derivatives = products.col(kMoments);
  const GraphGeometry geometry = graph_geometry(derivatives);
  LocalEstimate e;
  e.position = frame.to_world({0.0, derivatives[0]});
  e.tangent_angle = wrap_angle(std::atan2(frame.axis.y(), frame.axis.x()) + geometry.angle);
  e.kappa = geometry.kappa / unit;
  e.kappa_s = geometry.kappa_s / (unit * unit);
  Eigen::Matrix<double, 5, 5> covariance = variance_of_unit * products.leftCols<kLacking>();
  // A term that the polynomial lacks goes partly into the terms that it has, because few samples
  // cannot distinguish them.
  for (int k = 0; k < kTailTerms; ++k) {
    const Eigen::Matrix<double, 5, 1> missing = basis.col(kSize + k) - products.col(kLacking + k);
    covariance += prior.tail_variances[k] * missing * missing.transpose();
  }
  // The grid points differ in how much of each term they keep.
  const Eigen::Matrix<double, 5, kPriorTerms> terms =
      inner.rightCols<kPriorTerms>() * free.tail<kPriorTerms>().asDiagonal();
  covariance += terms.lazyProduct(prior.apart).eval().lazyProduct(terms.transpose());
  const Eigen::Vector4d units(unit, 1.0, 1.0 / unit, 1.0 / (unit * unit));
  const Eigen::Matrix<double, 4, 5> rows = units.asDiagonal() * geometry.jacobian;
  e.covariance = rows.lazyProduct(covariance).eval().lazyProduct(rows.transpose());
  const double length = arc_length<kSize>(c, frame.first_u, frame.last_u);
  const double longer = length / (frame.last_u - frame.first_u);
  e.window_arc_m = longer * straight.arc_m(abscissa_at(frame.first_u), abscissa_at(frame.last_u));
  e.sigma_m = noise;
  e = straight.to_world(e);
  result.estimate = e;
  result.status = LocalStatus::Ok;
  if (!is_finite(e)) {
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
  // Form deviation hides whether the path is a circle. Such windows are as long as a graph allows.
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
