// Arc length by adaptive Gauss-Legendre quadrature, and its inverse, for any speed function.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

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
double adaptive(const Speed& speed, double t0, double t1, double whole, int depth) {
  constexpr double kRelative = 1e-14;
  constexpr int kDeepest = 48;
  const double middle = 0.5 * (t0 + t1);
  const double left = gauss(speed, t0, middle);
  const double right = gauss(speed, middle, t1);
  const double halves = left + right;
  if (depth >= kDeepest || std::abs(halves - whole) <= kRelative * std::abs(halves)) {
    return halves;
  }
  return adaptive(speed, t0, middle, left, depth + 1) +
         adaptive(speed, middle, t1, right, depth + 1);
}

}  // namespace arc_length_detail

/// Integral of the speed (>= 0, smooth on the open interval) from t0 to t1, negative if t1 < t0.
/// Each piece is halved until halving changes it by less than 1e-14 of itself.
template <typename Speed>
double integrate_speed(const Speed& speed, double t0, double t1) {
  return arc_length_detail::adaptive(speed, t0, t1, arc_length_detail::gauss(speed, t0, t1), 0);
}

/// The t with length(t0, t) = s, where length grows with t at `speed` (> 0 but at isolated points):
/// Newton's method inside a bracket that grows until it holds the answer.
template <typename Length, typename Speed>
double invert_arc_length(const Length& length, const Speed& speed, double t0, double s,
                         double first_step) {
  if (s == 0.0) {
    return t0;
  }
  double step = std::copysign(first_step, s);
  double near = t0;
  double far = t0 + step;
  constexpr int kMostDoublings = 200;
  for (int i = 0; i < kMostDoublings && std::abs(length(t0, far)) < std::abs(s); ++i) {
    near = far;
    step *= 2.0;
    far = t0 + step;
  }
  double t = 0.5 * (near + far);
  constexpr int kMostIterations = 100;
  for (int i = 0; i < kMostIterations; ++i) {
    const double excess = length(t0, t) - s;
    (std::abs(length(t0, t)) < std::abs(s) ? near : far) = t;
    const double v = speed(t);
    double next = v > 0.0 ? t - excess / v : 0.5 * (near + far);
    if (!((next - near) * (next - far) < 0.0)) {
      next = 0.5 * (near + far);
    }
    if (std::abs(next - t) <= 1e-16 * std::abs(t) || next == t) {
      return next;
    }
    t = next;
  }
  return t;
}

}  // namespace palpate
