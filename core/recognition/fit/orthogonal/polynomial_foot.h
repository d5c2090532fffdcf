// The foot point of a point on a polynomial curve, near a given parameter.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/curves/algebraic/polynomial_curve.h"
#include "core/curves/plane_curve.h"
#include "core/numerics/polynomials/real_roots.h"

namespace palpate {

/// A point's foot point and distance.
struct PlacedPoint {
  double t = 0.0;                ///< parameter of the foot point
  double signed_distance = 0.0;  ///< positive to the left of increasing t, about a cusp too
  Vec2 normal = Vec2::Zero();    ///< unit, left of increasing t; at a cusp along the distance
};

/// Size of the last step for which a foot point is accurate enough for noise of standard deviation
/// `sigma`, normalised. After it the parameter's error is the cube of the step times a factor that
/// sharp bends make large. The distance's error is of second order: a small part of the noise.
inline double last_foot_step(double sigma) {
  constexpr double kSharpest = 1e5;  // features of 1 / 300 of the half extent, squared
  constexpr double kPart = 1e-3;
  return std::cbrt(std::sqrt(kPart * sigma) / kSharpest);
}

/// For exact points: the foot is accurate to rounding.
inline constexpr double kExactFootStep = 1e-5;

/// Whether t has come to a cusp that is the curve's nearest place to `p` (a semi-cubical parabola's
/// at t = 0): both arms lead away from it.
inline bool is_nearest_cusp(const PolynomialCoefficients& c, const Vec2& p, double t) {
  // Of the distance: the curve is that near to the cusp.
  constexpr double kAtCusp = 1e-2;
  const Vec2 away = p - c.col(0);
  return c.col(1).isZero(0.0) && away.dot(c.col(2)) < 0.0 &&
         t * t * t * t * c.col(2).squaredNorm() < kAtCusp * kAtCusp * away.squaredNorm();
}

/// What a point stands for: a place of the surface, within noise of its curve, or a round tip's
/// centre, which is off it by the tip's radius.
enum class PointOf { Surface, Tip };

/// Follows the foot point of `p` from `t` by Halley's method on (C(t) - p) . C'(t) = 0, until a
/// step is shorter than `last_step`.
inline PlacedPoint follow_foot_point(const PolynomialCoefficients& c, const Vec2& p, double t,
                                     double last_step = kExactFootStep,
                                     PointOf of = PointOf::Surface) {
  constexpr int kMaxIterations = 5;  // each step trebles the digits: four from half a digit to all
  constexpr double kLongestStep = 0.5;  // of the data's parameter range, about [-1, 1]
  Vec2 away;
  Vec2 first;
  double speed2 = 0.0;
  bool last = false;
  for (int iteration = 0;; ++iteration) {
    away = p - position_at(c, t);
    first = first_derivative(c, t);
    speed2 = first.squaredNorm();
    if (last || iteration == kMaxIterations || speed2 <= 0.0) {
      break;
    }
    const Vec2 second = second_derivative(c, t);
    const double along = away.dot(first);
    const double slope = speed2 - away.dot(second);
    double step = 0.0;
    if (slope < kLeastFootSlope * speed2) {
      step = along / speed2;  // a Gauss-Newton step is safe
    } else {
      // Includes the second derivative of (C - p) . C' if that is only a correction.
      const double bend = along * (3.0 * first.dot(second) - 6.0 * away.dot(c.col(3)));
      const double halley = 2.0 * slope * slope + bend;
      step = halley > slope * slope ? 2.0 * along * slope / halley : along / slope;
    }
    step = std::clamp(step, -kLongestStep, kLongestStep);
    last = std::abs(step) < last_step;
    t += step;
  }
  PlacedPoint placed;
  placed.t = t;
  if (speed2 > 0.0) {
    placed.normal = left_of(first) / std::sqrt(speed2);
    placed.signed_distance = away.dot(placed.normal);
  }
  // At a cusp, or if the foot point is not stationary, the normal does not point along the
  // distance: uses the distance itself. (Next to the curve a small error along it looks the same.)
  constexpr double kPerpendicular = 0.9;
  const double square = away.squaredNorm();
  const bool stationary = std::abs(away.dot(first)) < last_step * speed2;
  const bool across =
      placed.signed_distance * placed.signed_distance >= kPerpendicular * kPerpendicular * square;
  if ((of == PointOf::Tip && is_nearest_cusp(c, p, t)) || (!stationary && !across)) {
    // What has a cusp for its nearest place lies outside of the bend, as what is there on both
    // arms.
    const double outside = cross(second_derivative(c, t), Vec2(c.col(3)));
    placed.signed_distance = std::copysign(std::sqrt(square), outside);
    placed.normal = away / placed.signed_distance;
  }
  return placed;
}

/// Calls `visit(t)` where the distance of `p` from the curve is stationary.
template <typename Visit>
void visit_stationary(const PolynomialCoefficients& c, const Vec2& p, const Visit& visit) {
  // (C(t) - p) . C'(t) = 0.
  const Vec2 away = c.col(0) - p;
  Polynomial<5> condition;
  condition << away.dot(c.col(1)), 2.0 * away.dot(c.col(2)) + c.col(1).squaredNorm(),
      3.0 * (away.dot(c.col(3)) + c.col(1).dot(c.col(2))),
      4.0 * c.col(1).dot(c.col(3)) + 2.0 * c.col(2).squaredNorm(), 5.0 * c.col(2).dot(c.col(3)),
      3.0 * c.col(3).squaredNorm();
  visit_real_roots<5>(condition, visit);
}

/// The parameter of the curve's nearest place to `p`, anywhere on the curve; 0 if the curve is a
/// point.
inline double nearest_parameter(const PolynomialCoefficients& c, const Vec2& p) {
  double nearest = 0.0;
  double least = std::numeric_limits<double>::infinity();
  visit_stationary(c, p, [&](double t) {
    const double square = (position_at(c, t) - p).squaredNorm();
    if (square < least) {
      least = square;
      nearest = t;
    }
  });
  return nearest;
}

}  // namespace palpate
