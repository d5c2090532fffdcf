#include "core/recognition/fit/starts/axis_fit.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/curves/algebraic/polynomial_curve.h"
#include "core/numerics/least_squares.h"
#include "core/recognition/fit/starts/axis_residuals.h"

namespace palpate {
namespace {

template <PolynomialModel kModel>
AxisFit refine(std::span<const FitPoint> points, AxisFit fit, int max_iterations,
               WorkBudget& work) {
  using Residuals = AxisResiduals<kModel>;
  const Residuals residuals(points, fit.arms);
  // A start for the refinement proper: chi-square to a tenth is plenty.
  constexpr double kChi2Tolerance = 0.1;
  // What no noise leaves need not be known so well: two walks that end so near are one valley's
  // (polynomial_search.cpp).
  constexpr double kRelativeTolerance = 1e-2;
  Eigen::Matrix<double, Residuals::NUM_PARAMETERS, 1> x;
  x[0] = fit.theta;
  if constexpr (Residuals::kArms) {
    x[1] = fit.x0;
  }
  fit.chi2 = minimise_residuals(residuals,
                                {.iterations = max_iterations,
                                 .chi2_tolerance = kChi2Tolerance,
                                 .relative_tolerance = kRelativeTolerance,
                                 .coarse_above = most_chi2_of_noise(points),
                                 .work = &work,
                                 .row = WorkKind::AxisRow,
                                 .rows = points.size()},
                                &x)
                 .chi2;
  fit.theta = x[0];
  if constexpr (Residuals::kArms) {
    fit.x0 = x[1];
  }
  return fit;
}

/// Coefficients of y in powers of u at given nonlinear parameters.
template <PolynomialModel kModel>
std::array<double, 4> across_coefficients(const AxisFit& fit, std::span<const FitPoint> points) {
  using Residuals = AxisResiduals<kModel>;
  const Residuals residuals(points, fit.arms);
  std::vector<double> scratch(points.size());
  const double x[2] = {fit.theta, fit.x0};
  residuals(x, scratch.data(), nullptr);
  std::array<double, 4> y{};
  for (int k = 0; k < Residuals::kLinear; ++k) {
    y[static_cast<std::size_t>(Residuals::kPowers[static_cast<std::size_t>(k)])] =
        residuals.coefficients()[k];
  }
  return y;
}

std::array<double, 4> across_coefficients(const AxisFit& fit, std::span<const FitPoint> points) {
  switch (fit.model) {
    case PolynomialModel::Parabola:
      return across_coefficients<PolynomialModel::Parabola>(fit, points);
    case PolynomialModel::CubicalParabola:
      return across_coefficients<PolynomialModel::CubicalParabola>(fit, points);
    case PolynomialModel::SemiCubicalParabola:
      return across_coefficients<PolynomialModel::SemiCubicalParabola>(fit, points);
    case PolynomialModel::CubicSpline:
      break;
  }
  return across_coefficients<PolynomialModel::CubicSpline>(fit, points);
}

/// The spline with its vertex moved by -factor * c / a, at most to just before the leftmost point.
AxisFit with_vertex_moved(const AxisFit& spline, std::span<const FitPoint> points, double factor) {
  const std::array<double, 4> y = across_coefficients(spline, points);
  const Vec2 axis(std::cos(spline.theta), std::sin(spline.theta));
  double least = std::numeric_limits<double>::infinity();
  for (const FitPoint& point : points) {
    least = std::min(least, point.position.dot(axis));
  }
  constexpr double kJustBefore = 1e-3;  // half extents of the data
  AxisFit moved = spline;
  const double step = factor * y[1] / y[3];
  moved.x0 = std::min(std::isfinite(step) ? spline.x0 - step : spline.x0, least - kJustBefore);
  return moved;
}

}  // namespace

double verticality(const FitPoint& point, const Vec2& axis) {
  // 2 degrees: half a step of the axes tried (polynomial_seeds.cpp), so that none is told better.
  constexpr double kLeast = 0.03;
  constexpr double kUnknownDirection = 0.7;  // root mean square of the cosine
  if (point.tangent.isZero()) {
    return kUnknownDirection;
  }
  return std::max(std::abs(point.tangent.dot(axis)), kLeast);
}

AxisFit refine_axis(std::span<const FitPoint> points, AxisFit start, int max_iterations,
                    WorkBudget& work) {
  switch (start.model) {
    case PolynomialModel::Parabola:
      return refine<PolynomialModel::Parabola>(points, std::move(start), max_iterations, work);
    case PolynomialModel::CubicalParabola:
      return refine<PolynomialModel::CubicalParabola>(points, std::move(start), max_iterations,
                                                      work);
    case PolynomialModel::SemiCubicalParabola:
      return refine<PolynomialModel::SemiCubicalParabola>(points, std::move(start), max_iterations,
                                                          work);
    case PolynomialModel::CubicSpline:
      break;
  }
  return refine<PolynomialModel::CubicSpline>(points, std::move(start), max_iterations, work);
}

bool reassign_arms(std::span<const FitPoint> points, std::span<const PatchSpan> patches,
                   AxisFit* fit) {
  const Vec2 axis(std::cos(fit->theta), std::sin(fit->theta));
  const std::array<double, 4> y = across_coefficients(*fit, points);
  bool changed = false;
  std::vector<double> advantage;  // of the positive arm over the negative one, point by point
  for (const PatchSpan& patch : patches) {
    advantage.clear();
    double all = 0.0;
    for (std::size_t i = patch.begin; i < patch.end; ++i) {
      const double w = points[i].inverse_sigma * verticality(points[i], axis);
      const double t = std::sqrt(std::max(points[i].position.dot(axis) - fit->x0, 0.0));
      const double even = cross(axis, points[i].position) - y[0] - y[2] * t * t;
      const double odd = y[1] * t + y[3] * t * t * t;
      // (even + odd)^2 - (even - odd)^2
      advantage.push_back(4.0 * w * w * even * odd);
      all += advantage.back();
    }
    // Positive before the change and negative after it, or the other way round.
    double before = 0.0;
    double best = std::max(all, -all);
    double first = all >= 0.0 ? 1.0 : -1.0;
    std::size_t change = patch.size();
    for (std::size_t k = 1; k < patch.size(); ++k) {
      before += advantage[k - 1];
      const double gain = 2.0 * before - all;
      if (std::abs(gain) > best) {
        best = std::abs(gain);
        first = gain >= 0.0 ? 1.0 : -1.0;
        change = k;
      }
    }
    for (std::size_t k = 0; k < patch.size(); ++k) {
      const double arm = k < change ? first : -first;
      changed = changed || arm != fit->arms[patch.begin + k];
      fit->arms[patch.begin + k] = arm;
    }
  }
  return changed;
}

AxisFit twin_of(const AxisFit& spline, std::span<const FitPoint> points) {
  return with_vertex_moved(spline, points, 4.0 / 3.0);
}

AxisFit semi_cubical_near(const AxisFit& spline, std::span<const FitPoint> points) {
  AxisFit near = with_vertex_moved(spline, points, 2.0 / 3.0);
  near.model = PolynomialModel::SemiCubicalParabola;
  return near;
}

PolynomialFit to_polynomial(const AxisFit& fit, std::span<const FitPoint> points) {
  const Vec2 axis(std::cos(fit.theta), std::sin(fit.theta));
  std::array<double, 4> y = across_coefficients(fit, points);
  std::array<double, 4> x{0.0, 1.0, 0.0, 0.0};
  double shift = 0.0;
  if (!fit.arms.empty()) {
    x = {fit.x0, 0.0, 1.0, 0.0};
  } else if (fit.model == PolynomialModel::CubicalParabola) {
    // Move the origin of t to the inflection, where t^2 drops out. From 50 half extents away the
    // curvature changes by 4 % over the data: an inflection farther away is as good as none, and
    // the way starts there. Starts from farther out end in a valley along which all fit alike.
    constexpr double kFarthestInflection = 50.0;
    if (std::abs(y[2]) > 3.0 * kFarthestInflection * std::abs(y[3])) {
      y[3] = std::copysign(std::abs(y[2]) / (3.0 * kFarthestInflection), y[3]);
    }
    shift = y[3] != 0.0 ? -y[2] / (3.0 * y[3]) : 0.0;
    x[0] = shift;
    y = {y[0] + shift * (y[1] + shift * (y[2] + shift * y[3])),
         y[1] + shift * (2.0 * y[2] + 3.0 * shift * y[3]), 0.0, y[3]};
  }
  PolynomialFit result;
  for (std::size_t k = 0; k < 4; ++k) {
    result.coefficients.col(static_cast<Eigen::Index>(k)) = x[k] * axis + y[k] * left_of(axis);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double along = points[i].position.dot(axis);
    result.t.push_back(fit.arms.empty() ? along - shift
                                        : fit.arms[i] * std::sqrt(std::max(along - fit.x0, 0.0)));
  }
  result.chi2 = fit.chi2;
  normalise_parameter(fit.model, &result);
  return result;
}

void normalise_parameter(PolynomialModel model, PolynomialFit* fit) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const double t : fit->t) {
    least = std::min(least, t);
    most = std::max(most, t);
  }
  PolynomialCoefficients& c = fit->coefficients;
  double shift = 0.0;
  if (model == PolynomialModel::Parabola || model == PolynomialModel::CubicSpline) {
    shift = 0.5 * (least + most);
    c = PolynomialCurve2{c}.shifted(shift).coefficients;
  }
  const double scale = std::max(std::abs(least - shift), std::abs(most - shift));
  if (!(scale > 0.0)) {
    return;
  }
  c.col(1) *= scale;
  c.col(2) *= scale * scale;
  c.col(3) *= scale * scale * scale;
  for (double& t : fit->t) {
    t = (t - shift) / scale;
  }
}

}  // namespace palpate
