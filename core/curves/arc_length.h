// Arc length by adaptive Gauss-Legendre quadrature, and its inverse, for any speed function.
// Quadrature is used because the difference of two antiderivatives would lose the digits of short
// arcs far from the origin.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>

namespace palpate {

namespace arc_length_detail {

// Nodes and weights of the 12-point rule on [-1, 1] (positive half).
inline constexpr std::array<double, 6> kNodes = {
    0.1252334085114689154724414, 0.3678314989981801937526915, 0.5873179542866174472967024,
    0.7699026741943046870368938, 0.9041172563704748566784659, 0.9815606342467192506905491};
inline constexpr std::array<double, 6> kWeights = {
    0.2491470458134027850005624, 0.2334925365383548087608499, 0.2031674267230659217490645,
    0.1600783285433462263346525, 0.1069393259953184309602547, 0.0471753363865118271946160};

template <typename Speed>
double gauss(const Speed& speed, double t0, double t1) {
  const double middle = 0.5 * (t0 + t1);
  const double half = 0.5 * (t1 - t0);
  double sum = 0.0;
  for (std::size_t i = 0; i < kNodes.size(); ++i) {
    sum += kWeights[i] * (speed(middle - half * kNodes[i]) + speed(middle + half * kNodes[i]));
  }
  return half * sum;
}

template <typename Speed>
double adaptive(const Speed& speed, double t0, double t1, double whole, double tolerance,
                int depth) {
  // Next to a singularity of the speed every level halves the piece that contains it. A piece below
  // 2^-60 of the arc no longer matters.
  constexpr int kDeepest = 60;
  const double middle = 0.5 * (t0 + t1);
  const double left = gauss(speed, t0, middle);
  const double right = gauss(speed, middle, t1);
  const double halves = left + right;
  if (depth >= kDeepest || !(std::abs(halves - whole) > tolerance)) {
    return halves;
  }
  return adaptive(speed, t0, middle, left, tolerance, depth + 1) +
         adaptive(speed, middle, t1, right, tolerance, depth + 1);
}

}  // namespace arc_length_detail

/// The rounding of a polynomial whose terms have this sum of absolute values, up to the third
/// power: of terms and sums, and three times that of t.
inline double rounding_of_terms(double terms) {
  return 4.0 * std::numeric_limits<double>::epsilon() * terms;
}

/// Integral of the speed (>= 0, smooth on the open interval) from t0 to t1, negative if t1 < t0. A
/// piece is halved as long as halving changes it by more than 16 epsilon of the whole arc, which is
/// the rounding of a sum of 12 terms. The rule is of order 24, so the halves are far more exact
/// than that. `rounding`: how far off values of the speed may be, beyond a few epsilon of them.
/// Where large terms of a speed cancel, halving changes a piece by that without an end.
template <typename Speed>
double integrate_speed(const Speed& speed, double t0, double t1, double rounding) {
  assert(!(rounding < 0.0));
  constexpr double kRelative = 16.0 * std::numeric_limits<double>::epsilon();
  const double whole = arc_length_detail::gauss(speed, t0, t1);
  // A piece and its halves are each off by so much, at most.
  const double tolerance = kRelative * std::abs(whole) + 2.0 * rounding * std::abs(t1 - t0);
  return arc_length_detail::adaptive(speed, t0, t1, whole, tolerance, 0);
}

/// The same for a speed that is not smooth at t = 0, or nearly so: each side of it by itself.
template <typename Speed>
double integrate_speed_by_sides(const Speed& speed, double t0, double t1, double rounding) {
  return t0 * t1 < 0.0
             ? integrate_speed(speed, t0, 0.0, rounding) + integrate_speed(speed, 0.0, t1, rounding)
             : integrate_speed(speed, t0, t1, rounding);
}

/// The t at signed arc length s from t0. length(u, v) is the signed arc length from u to v;
/// speed(t) is its derivative by v, > 0 except at isolated points. Newton's method on the remaining
/// arc, within a bracket whose far side is open until a step overshoots. Until then no step exceeds
/// `first_step` (> 0) or twice the step before.
template <typename Length, typename Speed>
double invert_arc_length(const Length& length, const Speed& speed, double t0, double s,
                         double first_step) {
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  constexpr int kMostIterations = 1100;  // more doublings or halvings leave the range of a double
  const double sign = s < 0.0 ? -1.0 : 1.0;
  double near = t0;
  double far = sign * std::numeric_limits<double>::infinity();
  double t = t0;
  double remaining = s;
  double longest = first_step;
  double travelled = 0.0;
  for (int i = 0; i < kMostIterations; ++i) {
    const double newton = remaining / speed(t);  // infinite at a cusp
    // This test comes before the bracket: a step of rounding size may end on the bracket's border.
    if (std::abs(remaining) <= kEpsilon * std::abs(s) ||
        std::abs(newton) <= kEpsilon * std::abs(t)) {
      if (travelled <= 2.0 * std::abs(s)) {
        break;
      }
      // Long steps back and forth leave their rounding in `remaining`: measure it again from t0.
      remaining = s - length(t0, t);
      travelled = 0.0;
      continue;
    }
    (remaining * sign > 0.0 ? near : far) = t;
    double next = t + newton;
    if (std::isinf(far)) {
      next = t + sign * std::min(std::abs(newton), longest);
      longest *= 2.0;
    } else if (!((next - near) * (next - far) < 0.0)) {
      next = 0.5 * (near + far);
    }
    if (next == t) {
      break;
    }
    const double passed = length(t, next);
    remaining -= passed;
    travelled += std::abs(passed);
    t = next;
  }
  return t;
}

}  // namespace palpate
