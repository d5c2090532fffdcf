#include "core/part/knotted_cubic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/curves/algebraic/polynomial_curve.h"
#include "core/numerics/least_squares.h"
#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/fit/starts/axis_fit.h"
#include "core/recognition/smooth/smooth_model.h"

namespace palpate {
namespace {

CurveDerivatives derivatives(const KnottedCubic& curve, double t) {
  CurveDerivatives d = PolynomialCurve2{curve.coefficients}.derivatives(t);
  const double beyond = t - curve.knot;
  if (beyond > 0.0) {
    d.position += beyond * beyond * beyond * curve.bend;
    d.first += 3.0 * beyond * beyond * curve.bend;
    d.second += 6.0 * beyond * curve.bend;
    d.third += 6.0 * curve.bend;
  }
  return d;
}

/// The foot of `point`, by Newton's method from a nearby t. The points lie on the curve up to
/// noise.
double follow_foot(const KnottedCubic& curve, const Vec2& point, double t) {
  constexpr int kMostIterations = 8;     // the digits double near the foot
  constexpr double kLastStep = 1e-8;     // after so short a step the error is its square
  constexpr double kLongestStep = 0.25;  // of the parameter range [-1, 1]
  for (int i = 0; i < kMostIterations; ++i) {
    const CurveDerivatives d = derivatives(curve, t);
    const Vec2 away = point - d.position;
    const double speed2 = d.first.squaredNorm();
    const double second = speed2 - away.dot(d.second);
    const double slope = second > 0.1 * speed2 ? second : speed2;
    if (!(slope > 0.0)) {
      break;
    }
    const double step = std::clamp(away.dot(d.first) / slope, -kLongestStep, kLongestStep);
    t += step;
    if (std::abs(step) < kLastStep) {
      break;
    }
  }
  return t;
}

/// Parameters: two coefficients of each power, then the bend. kParameters = 8 holds the bend fixed.
template <int kParameters>
class KnottedResiduals {
 public:
  enum { NUM_PARAMETERS = kParameters };
  using Parameters = Eigen::Matrix<double, kParameters, 1>;

  KnottedResiduals(std::span<const FitPoint> points, const KnottedCubicFit& start)
      : points_(points), start_(start) {}

  int NumResiduals() const { return static_cast<int>(points_.size()); }

  KnottedCubic curve(const Parameters& x) const {
    KnottedCubic curve = start_.curve;
    for (int k = 0; k < 4; ++k) {
      curve.coefficients.col(k) = x.template segment<2>(2 * k);
    }
    if constexpr (kParameters == 10) {
      curve.bend = x.template tail<2>();
    }
    return curve;
  }

  Parameters parameters() const {
    Parameters x;
    for (int k = 0; k < 4; ++k) {
      x.template segment<2>(2 * k) = start_.curve.coefficients.col(k);
    }
    if constexpr (kParameters == 10) {
      x.template tail<2>() = start_.curve.bend;
    }
    return x;
  }

  bool operator()(const double* x_data, double* residuals, double* jacobian) const {
    const KnottedCubic trial = curve(Eigen::Map<const Parameters>(x_data));
    const std::size_t n = points_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const FitPoint& point = points_[i];
      const double t = follow_foot(trial, point.position, start_.t[i]);
      const CurveDerivatives d = derivatives(trial, t);
      const Vec2 normal = left_of(d.first).normalized();
      const double distance = normal.dot(point.position - d.position);
      residuals[i] = (distance - start_.side * point.offset) * point.inverse_sigma;
      if (jacobian != nullptr) {
        double power = -point.inverse_sigma;
        for (std::size_t k = 0; k < 4; ++k) {
          jacobian[2 * k * n + i] = normal.x() * power;
          jacobian[(2 * k + 1) * n + i] = normal.y() * power;
          power *= t;
        }
        if constexpr (kParameters == 10) {
          const double beyond = std::max(t - trial.knot, 0.0);
          const double bend = -point.inverse_sigma * beyond * beyond * beyond;
          jacobian[8 * n + i] = normal.x() * bend;
          jacobian[9 * n + i] = normal.y() * bend;
        }
      }
    }
    return true;
  }

 private:
  std::span<const FitPoint> points_;
  const KnottedCubicFit& start_;
};

template <int kParameters>
KnottedCubicFit refine(std::span<const FitPoint> points, const KnottedCubicFit& start) {
  using Residuals = KnottedResiduals<kParameters>;
  const Residuals residuals(points, start);
  // A tolerance of chi-square far below what affects odds. Where two cubics fit, each step at least
  // halves the error.
  constexpr int kMostIterations = 30;
  constexpr double kChi2Tolerance = 1e-6;
  typename Residuals::Parameters x = residuals.parameters();
  const auto summary = minimise_residuals(residuals, {kMostIterations, kChi2Tolerance}, &x);
  KnottedCubicFit fit = start;
  fit.curve = residuals.curve(x);
  fit.chi2 = summary.chi2;
  for (std::size_t i = 0; i < points.size(); ++i) {
    fit.t[i] = follow_foot(fit.curve, points[i].position, start.t[i]);
  }
  return fit;
}

/// Converts the fit so that t runs from -1 to 1 over the points, in their order.
KnottedCubicFit rescaled(PolynomialFit fit) {
  normalise_parameter(PolynomialModel::CubicSpline, &fit);
  if (fit.t.back() < fit.t.front()) {
    fit.coefficients.col(1) *= -1.0;
    fit.coefficients.col(3) *= -1.0;
    fit.side = -fit.side;
    for (double& t : fit.t) {
      t = -t;
    }
  }
  KnottedCubicFit result;
  result.curve.coefficients = fit.coefficients;
  result.t = std::move(fit.t);
  result.side = fit.side;
  result.chi2 = fit.chi2;
  return result;
}

}  // namespace

Vec2 KnottedCubic::position(double t) const { return derivatives(*this, t).position; }

Vec2 KnottedCubic::left(double t) const {
  return left_of(derivatives(*this, t).first).normalized();
}

KnottedCubicFit fit_single_cubic(const FitData& data) {
  FitData points = data;
  const SmoothModel smooth = fit_smooth_model(&points, true);
  WorkBudget unbounded;
  const ClassFits fits = fit_classes(smooth.reduced, unbounded);
  KnottedCubicFit best;
  best.chi2 = std::numeric_limits<double>::infinity();
  for (const CurveClass curve_class : {CurveClass::CubicSpline, CurveClass::SemiCubicalParabola,
                                       CurveClass::CubicalParabola, CurveClass::Parabola}) {
    const auto& coarse = fits[curve_class];
    if (!coarse || !coarse->polynomial) {
      continue;
    }
    const auto refined = refine_on_all(settled(*coarse, smooth.reduced, RivalOf::Best, unbounded),
                                       smooth, points, kOnAllEffort, unbounded);
    PolynomialFit polynomial =
        refined && refined->polynomial ? *refined->polynomial : *coarse->polynomial;
    if (polynomial.t.size() != points.points.size()) {
      // No such curve fits all the points, for example because several segments meet. It is used as
      // a start all the same.
      std::vector<double> t;
      for (const std::uint32_t nearest : smooth.nearest_reduced) {
        t.push_back(polynomial.t[nearest]);
      }
      polynomial.t = std::move(t);
    }
    KnottedCubicFit fit = refine_knotted(points.points, rescaled(std::move(polynomial)), false);
    if (fit.chi2 < best.chi2) {
      best = std::move(fit);
    }
  }
  return best;
}

KnottedCubicFit refine_knotted(std::span<const FitPoint> points, const KnottedCubicFit& start,
                               bool bends) {
  return bends ? refine<10>(points, start) : refine<8>(points, start);
}

}  // namespace palpate
