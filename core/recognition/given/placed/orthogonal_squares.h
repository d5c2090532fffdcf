// The sum of squared orthogonal distances of a placed curve, with gradient and exact Hessian.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <type_traits>

#include "core/recognition/given/placed/placed_curve.h"

namespace palpate {

/// A point to be fitted, in the points' frame.
template <typename T>
struct WeighedPoint {
  PlaneVector<T> position;
  T weight{};               ///< of the residual: 1 / standard deviation; 1 if none is stated
  T offset{};               ///< signed distance that the point should have: side times tip radius
  PlaneVector<T> normal{};  ///< measured, unit; its sign does not matter
  T normal_weight{};        ///< 1 / standard deviation of its direction; 0 = no normal
  std::size_t stroke = 0;   ///< neighbours of the same one follow one another along it; 0 = none
  bool stated = false;      ///< the weight is that of a stated noise
};

template <typename T>
using SquareMatrix = std::array<std::array<T, kMostUnknowns>, kMostUnknowns>;

/// Half the sum of squares near a curve: cost + gradient . d + d . hessian . d / 2.
template <typename T>
struct Squares {
  T cost{};
  std::array<T, kMostUnknowns> gradient{};
  SquareMatrix<T> hessian{};      ///< exact for the distances; Gauss-Newton for the normals
  SquareMatrix<T> information{};  ///< Gauss-Newton part of it: positive semi-definite
};

/// A point relative to the curve, in the curve's frame.
template <typename T>
struct Placement {
  CurvePoint<T> foot;
  PlaneVector<T> normal;  ///< unit, left of increasing t; at a cusp towards the point
  T distance{};           ///< positive along the normal
  T speed{};              ///< length of the tangent vector C'; 0 at a cusp
  T slope{};              ///< derivative of (C - p) . C' by the parameter
};

/// The parameter moved by `step`: rotated on circle and ellipse, else added.
template <typename T>
PlaneVector<T> advanced(CurveClass curve_class, const PlaneVector<T>& parameter, const T& step) {
  using std::sqrt;
  if (curve_class == CurveClass::Circle || curve_class == CurveClass::Ellipse) {
    const PlaneVector<T> next = turned(parameter, step);
    return T(1.0) / sqrt(inner(next, next)) * next;
  }
  return {parameter.x + step, parameter.y};
}

/// Follows the foot point of `point` from `parameter` by Newton's method. Each step doubles the
/// number of correct digits, so that one step after a small one is enough.
template <typename T>
Placement<T> place(const PlacedCurve<T>& curve, const PlaneVector<T>& point,
                   PlaneVector<T>* parameter) {
  using std::sqrt;
  constexpr int kMostSteps = 8;  // digits double: five steps to the 32 digits of an exact type
  // Its square is below the rounding of T.
  constexpr double kLastStep = std::is_same_v<T, double> ? 1e-8 : 1e-16;
  // A tangent shorter than this fraction of C'' counts as zero: a cusp.
  constexpr double kCusp = 1e-12;
  Placement<T> placed;
  PlaneVector<T> away;
  bool last = false;
  for (int i = 0;; ++i) {
    placed.foot = curve_point(curve.curve_class, curve.shape, *parameter);
    away = point - placed.foot.position;
    const T speed2 = inner(placed.foot.first, placed.foot.first);
    placed.slope = speed2 - inner(away, placed.foot.second);
    const double bend = std::sqrt(to_double(inner(placed.foot.second, placed.foot.second)));
    const double speed = std::sqrt(to_double(speed2));
    placed.speed = speed > kCusp * bend ? sqrt(speed2) : T(0.0);
    if (last || i == kMostSteps || !(to_double(placed.speed) > 0.0) ||
        !(to_double(placed.slope) > 0.0)) {
      break;
    }
    const T step = inner(away, placed.foot.first) / placed.slope;
    *parameter = advanced(curve.curve_class, *parameter, step);
    last = std::abs(to_double(step)) <= kLastStep * (1.0 + std::abs(to_double(parameter->x)));
  }
  if (to_double(placed.speed) > 0.0) {
    placed.normal = T(1.0) / placed.speed * left(placed.foot.first);
    placed.distance = inner(placed.normal, away);
  } else {
    placed.distance = sqrt(inner(away, away));
    placed.normal = to_double(placed.distance) > 0.0 ? T(1.0) / placed.distance * away
                                                     : PlaneVector<T>{T(1.0), T(0.0)};
  }
  return placed;
}

/// Angle from the curve's normal to the measured one, without regard to sign, as h = 2 tan(angle /
/// 2). It differs from the angle by angle^3 / 12 and needs no transcendental function. Turning the
/// curve's normal by d changes h by -(1 + h^2 / 4) d.
template <typename T>
T normal_miss(const PlacedCurve<T>& curve, const Placement<T>& placed,
              const PlaneVector<T>& measured) {
  const PlaneVector<T> m{inner(curve.axis, measured), inner(left(curve.axis), measured)};
  const T along = inner(placed.normal, m);
  const T across = inner(left(placed.normal), m);
  return to_double(along) >= 0.0 ? (across + across) / (T(1.0) + along)
                                 : (across + across) / (along - T(1.0));
}

/// True if the point has a normal and the curve has one at the foot.
template <typename T>
bool compares_normals(const Placement<T>& placed, const WeighedPoint<T>& point) {
  return to_double(point.normal_weight) > 0.0 && to_double(placed.speed) > 0.0 &&
         to_double(placed.slope) > 0.0;
}

/// Half the sum of squares. Moves the feet along.
template <typename T>
T half_squares(PlacedCurve<T>* curve, std::span<const WeighedPoint<T>> points) {
  T cost(0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Placement<T> placed = place(*curve, curve->to_curve(points[i].position), &curve->feet[i]);
    const T residual = points[i].weight * (placed.distance - points[i].offset);
    cost = cost + residual * residual;
    if (compares_normals(placed, points[i])) {
      const T miss = points[i].normal_weight * normal_miss(*curve, placed, points[i].normal);
      cost = cost + miss * miss;
    }
  }
  return T(0.5) * cost;
}

/// Half the sum of squares with derivatives by the unknowns q. With n the unit normal and T the
/// unit tangent at the foot, the derivative of the distance is -n . C_q (envelope theorem). Its
/// second derivative is T . C_q (n . dC'/dq) / |C'| - n . C_tq dt/dq - n . C_qq. Here dt/dq is the
/// foot's motion, and dC'/dq = C_tq + C'' dt/dq. The normals' residuals enter the Hessian only by
/// their first derivatives: the rest needs third derivatives of the curve, times residuals of
/// either sign, which nearly cancel.
template <typename T>
Squares<T> squares_about(PlacedCurve<T>* curve, std::span<const WeighedPoint<T>> points) {
  const Unknowns unknowns(curve->curve_class);
  const auto n = static_cast<std::size_t>(unknowns.count);
  Squares<T> sum;
  for (std::size_t point = 0; point < points.size(); ++point) {
    const Placement<T> placed =
        place(*curve, curve->to_curve(points[point].position), &curve->feet[point]);
    const CurvePoint<T>& foot = placed.foot;
    const T weight = points[point].weight;
    const T residual = weight * (placed.distance - points[point].offset);
    std::array<PlaneVector<T>, kMostUnknowns> by{};
    std::array<PlaneVector<T>, kMostUnknowns> first_by{};
    for (int i = 0; i < unknowns.shape; ++i) {
      by[static_cast<std::size_t>(i)] = foot.by_shape[i];
      first_by[static_cast<std::size_t>(i)] = foot.first_by_shape[i];
    }
    if (unknowns.x >= 0) {
      by[static_cast<std::size_t>(unknowns.x)] = {T(1.0), T(0.0)};
    }
    by[static_cast<std::size_t>(unknowns.y)] = {T(0.0), T(1.0)};
    if (unknowns.angle >= 0) {
      by[static_cast<std::size_t>(unknowns.angle)] = left(foot.position);
      first_by[static_cast<std::size_t>(unknowns.angle)] = left(foot.first);
    }
    const bool regular = to_double(placed.speed) > 0.0 && to_double(placed.slope) > 0.0;
    const PlaneVector<T> tangent =
        regular ? T(1.0) / placed.speed * foot.first : PlaneVector<T>{T(0.0), T(0.0)};
    std::array<T, kMostUnknowns> rate{};   // derivative of the distance
    std::array<T, kMostUnknowns> slide{};  // motion of the foot along the curve
    std::array<T, kMostUnknowns> turn{};   // turn of the normal
    std::array<T, kMostUnknowns> along{};
    for (std::size_t i = 0; i < n; ++i) {
      rate[i] = -inner(placed.normal, by[i]);
      if (regular) {
        slide[i] =
            (placed.distance * inner(placed.normal, first_by[i]) - inner(foot.first, by[i])) /
            placed.slope;
        along[i] = inner(tangent, by[i]);
        turn[i] = inner(placed.normal, first_by[i] + slide[i] * foot.second) / placed.speed;
      }
    }
    sum.cost = sum.cost + residual * residual;
    if (compares_normals(placed, points[point])) {
      const T by_normal = points[point].normal_weight;
      const T h = normal_miss(*curve, placed, points[point].normal);
      const T falls = by_normal * (T(1.0) + T(0.25) * h * h);
      sum.cost = sum.cost + by_normal * by_normal * h * h;
      for (std::size_t i = 0; i < n; ++i) {
        sum.gradient[i] = sum.gradient[i] - by_normal * h * falls * turn[i];
        for (std::size_t j = 0; j <= i; ++j) {
          const T square = falls * falls * turn[i] * turn[j];
          sum.information[i][j] = sum.information[i][j] + square;
          sum.hessian[i][j] = sum.hessian[i][j] + square;
        }
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      sum.gradient[i] = sum.gradient[i] + residual * weight * rate[i];
      for (std::size_t j = 0; j <= i; ++j) {
        const T square = weight * weight * rate[i] * rate[j];
        sum.information[i][j] = sum.information[i][j] + square;
        T second(0.0);
        if (regular) {
          second = along[i] * turn[j] - inner(placed.normal, first_by[i]) * slide[j];
        } else if (to_double(placed.distance) > 0.0) {
          // At a cusp the distance is that from a point.
          second = (inner(by[i], by[j]) - rate[i] * rate[j]) / placed.distance;
        }
        if (unknowns.angle >= 0 && i == static_cast<std::size_t>(unknowns.angle)) {
          if (j == i) {
            second = second + inner(placed.normal, foot.position);
          } else if (j < static_cast<std::size_t>(unknowns.shape)) {
            second = second - inner(placed.normal, left(foot.by_shape[j]));
          }
        }
        sum.hessian[i][j] = sum.hessian[i][j] + square + residual * weight * second;
      }
    }
  }
  sum.cost = T(0.5) * sum.cost;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      sum.hessian[j][i] = sum.hessian[i][j];
      sum.information[j][i] = sum.information[i][j];
    }
  }
  return sum;
}

}  // namespace palpate
