#include "core/recognition/fit/spline_limits.h"

#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "core/curves/algebraic/polynomial_curve.h"
#include "core/numerics/polynomials/real_roots.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/fit/starts/axis_fit.h"

namespace palpate {
namespace {

/// One coefficient more takes off a chi-square of one degree of freedom: in a third of all cases
/// above 1. A limit that leaves more than this beside the spline may have been missed.
constexpr double kMoreByChance = 1.0;

void start_from(const PolynomialFit& start, PolynomialModel model, const FitData& reduced,
                double out_of_reach, std::optional<PolynomialFit>* best, WorkBudget& work) {
  keep_better(best, refine_polynomial(model, reduced.points, start, kSurfacePoints,
                                      coarse(out_of_reach), work));
}

/// Whether the spline fits and its limit does not.
bool is_missed(const std::optional<PolynomialFit>& limit, const PolynomialFit& spline,
               const FitData& reduced) {
  const std::size_t residuals = residual_count(reduced);
  return fits_well(spline.chi2, residuals) && !fits_well(limit->chi2, residuals);
}

/// A spline counted from `origin`, without one power of its parameter.
PolynomialFit without_power(Eigen::Index power, double origin, const PolynomialFit& spline,
                            std::span<const FitPoint> points) {
  PolynomialFit fit = spline;
  fit.coefficients = PolynomialCurve2{spline.coefficients}.shifted(origin).coefficients;
  fit.coefficients.col(power).setZero();
  for (double& t : fit.t) {
    t -= origin;
  }
  return placed_on(points, std::move(fit));
}

/// The semi-cubical parabola that a spline nearly is: its cusp where the spline is slowest.
PolynomialFit semi_cubical_at(const PolynomialFit& spline, std::span<const FitPoint> points) {
  const PolynomialCoefficients& c = spline.coefficients;
  // Half of the squared speed's derivative.
  const Eigen::Vector4d slope(2.0 * c.col(1).dot(c.col(2)),
                              4.0 * c.col(2).squaredNorm() + 6.0 * c.col(1).dot(c.col(3)),
                              18.0 * c.col(2).dot(c.col(3)), 18.0 * c.col(3).squaredNorm());
  double slowest = 0.0;
  double least = std::numeric_limits<double>::infinity();
  visit_real_roots<3>(slope, [&](double t) {
    if (const double speed2 = first_derivative(c, t).squaredNorm(); speed2 < least) {
      least = speed2;
      slowest = t;
    }
  });
  return without_power(1, slowest, spline, points);
}

/// The cubical parabola that a spline nearly is, whose vertex is far away: without the second
/// derivative where that is least.
PolynomialFit cubical_at(const PolynomialFit& spline, std::span<const FitPoint> points) {
  const PolynomialCoefficients& c = spline.coefficients;
  const double inflection = -c.col(2).dot(c.col(3)) / (3.0 * c.col(3).squaredNorm());
  return without_power(2, inflection, spline, points);
}

}  // namespace

void start_spline_from_limits(const FitData& reduced, double highest_chi2, double out_of_reach,
                              PolynomialFits* fits, WorkBudget& work) {
  for (const auto* limit :
       {&fits->parabola, &fits->cubical_parabola, &fits->semi_cubical_parabola}) {
    if (*limit && (*limit)->chi2 <= highest_chi2 &&
        (!fits->cubic_spline || (*limit)->chi2 < fits->cubic_spline->chi2) && work.allows()) {
      PolynomialFit start = **limit;
      normalise_parameter(PolynomialModel::CubicSpline, &start);
      start_from(start, PolynomialModel::CubicSpline, reduced, out_of_reach, &fits->cubic_spline,
                 work);
    }
  }
}

void start_semi_cubical_from_spline(const FitData& reduced, double out_of_reach,
                                    PolynomialFits* fits, WorkBudget& work) {
  std::optional<PolynomialFit>& limit = fits->semi_cubical_parabola;
  const std::optional<PolynomialFit>& spline = fits->cubic_spline;
  if (!limit || !spline || limit->chi2 <= spline->chi2 || !work.allows()) {
    return;
  }
  const PolynomialFit start = semi_cubical_at(*spline, reduced.points);
  if (start.chi2 < limit->chi2 || is_missed(limit, *spline, reduced)) {
    start_from(start, PolynomialModel::SemiCubicalParabola, reduced, out_of_reach, &limit, work);
  }
}

PolynomialFit semi_cubical_from(const PolynomialFit& spline, const FitData& reduced,
                                double out_of_reach, WorkBudget& work) {
  return refine_polynomial(PolynomialModel::SemiCubicalParabola, reduced.points,
                           semi_cubical_at(spline, reduced.points), kSurfacePoints,
                           coarse(out_of_reach), work);
}

void start_cubical_from_spline(const FitData& reduced, double out_of_reach, PolynomialFits* fits,
                               WorkBudget& work) {
  std::optional<PolynomialFit>& limit = fits->cubical_parabola;
  const std::optional<PolynomialFit>& spline = fits->cubic_spline;
  // A steep flank is fitted as well by an arm of another axis, and not as closely.
  if (!limit || !spline || !fits_well(spline->chi2, residual_count(reduced)) ||
      limit->chi2 <= spline->chi2 + kMoreByChance || !work.allows()) {
    return;
  }
  start_from(cubical_at(*spline, reduced.points), PolynomialModel::CubicalParabola, reduced,
             out_of_reach, &limit, work);
  if (limit->chi2 <= spline->chi2 + kMoreByChance || !work.allows()) {
    return;
  }
  const Vec2 across = spline->coefficients.col(3);
  const double theta = std::atan2(across.y(), across.x()) - 0.5 * kPi;
  const AxisFit walked = refine_axis(
      reduced.points, {PolynomialModel::CubicalParabola, theta, 0.0, {}, 0.0}, kMostWalked, work);
  if (walked.chi2 < limit->chi2) {
    start_from(to_polynomial(walked, reduced.points), PolynomialModel::CubicalParabola, reduced,
               out_of_reach, &limit, work);
  }
}

}  // namespace palpate
