// Real roots of polynomials of small degree. Between neighbouring roots of its derivative a
// polynomial is monotone, so each change of sign there encloses exactly one root.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace palpate {

/// Coefficients of sum c_k x^k, c_0 first.
template <int kDegree>
using Polynomial = Eigen::Matrix<double, kDegree + 1, 1>;

namespace real_roots_detail {

/// In ascending order.
template <int kDegree>
struct Roots {
  std::array<double, static_cast<std::size_t>(kDegree)> x{};
  std::size_t count = 0;

  void push(double root) { x[count++] = root; }
};

template <int kDegree>
double value(const Polynomial<kDegree>& c, double x) {
  double sum = c[kDegree];
  for (int k = kDegree - 1; k >= 0; --k) {
    sum = sum * x + c[k];
  }
  return sum;
}

/// sum |c_k| distance^k, which the rounding of the value at +-distance is a part of.
template <int kDegree>
double terms(const Polynomial<kDegree>& c, double distance) {
  return value<kDegree>(c.cwiseAbs(), distance);
}

/// Newton's method inside a bracket, with bisection where Newton's method would be slow, until the
/// value is one that rounding leaves. The values at both ends have different signs.
template <int kDegree>
double bracketed_root(const Polynomial<kDegree>& c, double low, double high, double at_low,
                      double at_high) {
  constexpr double kRounding = std::numeric_limits<double>::epsilon();
  // Where the chord is 0; not too near an end, where the slope may be 0.
  constexpr double kNearestToEnd = 0.1;
  double x = low + (high - low) *
                       std::clamp(at_low / (at_low - at_high), kNearestToEnd, 1.0 - kNearestToEnd);
  double last_step = high - low;
  // Nowhere in the bracket is rounding more than its part of these.
  const double most_terms = terms<kDegree>(c, std::max(std::abs(low), std::abs(high)));
  // Newton's steps converge quadratically; 120 bisections would reach 2^-120.
  constexpr int kMostIterations = 120;
  for (int i = 0; i < kMostIterations; ++i) {
    double f = c[kDegree];
    double slope = 0.0;
    for (int k = kDegree - 1; k >= 0; --k) {
      slope = slope * x + f;
      f = f * x + c[k];
    }
    if (std::abs(f) <= kRounding * most_terms &&
        std::abs(f) <= kRounding * terms<kDegree>(c, std::abs(x))) {
      return x;
    }
    ((f < 0.0) == (at_low < 0.0) ? low : high) = x;
    const double newton = x - f / slope;
    const bool good = newton > low && newton < high && 2.0 * std::abs(newton - x) < last_step;
    const double next = good ? newton : 0.5 * (low + high);
    last_step = std::abs(next - x);
    if (last_step <= kRounding * std::abs(next)) {
      return next;
    }
    x = next;
  }
  return x;
}

/// For a polynomial whose roots, and those of its derivatives, lie in [-bound, bound]; c[kDegree]
/// != 0.
template <int kDegree>
Roots<kDegree> roots_within(const Polynomial<kDegree>& c, double bound) {
  Roots<kDegree> roots;
  if constexpr (kDegree == 1) {
    roots.push(-c[0] / c[1]);
  } else if constexpr (kDegree == 2) {
    const double discriminant = c[1] * c[1] - 4.0 * c[2] * c[0];
    if (discriminant < 0.0) {
      return roots;
    }
    // The root of larger size, of which no digits cancel; the other by their product c_0 / c_2.
    const double q = -0.5 * (c[1] + std::copysign(std::sqrt(discriminant), c[1]));
    const double larger = q / c[2];
    const double other = q == 0.0 ? 0.0 : c[0] / q;
    roots.push(std::min(larger, other));
    if (discriminant > 0.0) {
      roots.push(std::max(larger, other));
    }
  } else {
    Polynomial<kDegree - 1> derivative;
    for (int k = 1; k <= kDegree; ++k) {
      derivative[k - 1] = k * c[k];
    }
    const Roots<kDegree - 1> critical = roots_within<kDegree - 1>(derivative, bound);
    double low = -bound;
    double at_low = value<kDegree>(c, low);
    for (std::size_t i = 0; i <= critical.count; ++i) {
      const double high = i < critical.count ? critical.x[i] : bound;
      const double at_high = value<kDegree>(c, high);
      if (at_high == 0.0) {
        // A multiple root; the pieces on either side of it have no other root.
        if (roots.count < roots.x.size()) {
          roots.push(high);
        }
      } else if (at_low != 0.0 && (at_low < 0.0) != (at_high < 0.0)) {
        if (roots.count < roots.x.size()) {
          roots.push(bracketed_root<kDegree>(c, low, high, at_low, at_high));
        }
      }
      low = high;
      at_low = at_high;
    }
  }
  return roots;
}

}  // namespace real_roots_detail

/// Calls `visit(root)` for every real root of the polynomial. A root of odd multiplicity is never
/// missed. Two roots that rounding cannot separate may both be missed. Leading coefficients that
/// are 0 relative to the largest are dropped. Does not allocate.
template <int kDegree, typename Visit>
void visit_real_roots(const Polynomial<kDegree>& c, const Visit& visit) {
  const double largest = c.cwiseAbs().maxCoeff();
  if (!(largest > 0.0) || !std::isfinite(largest)) {
    return;
  }
  if (std::abs(c[kDegree]) <= std::numeric_limits<double>::min() * largest) {
    if constexpr (kDegree > 1) {
      visit_real_roots<kDegree - 1>(c.template head<kDegree>(), visit);
    }
    return;
  }
  // Fujiwara's bound: all roots lie within 2 scale. With x in units of scale, all coefficients are
  // at most 1.
  double scale = 0.0;
  for (int k = 1; k <= kDegree; ++k) {
    const double ratio = std::abs(c[kDegree - k] / c[kDegree]);
    // Explicit square and cube roots: the general power takes several times as long.
    const double root = k == 1   ? ratio
                        : k == 2 ? std::sqrt(ratio)
                        : k == 3 ? std::cbrt(ratio)
                        : k == 4 ? std::sqrt(std::sqrt(ratio))
                                 : std::pow(ratio, 1.0 / k);
    scale = std::max(scale, root);
  }
  if (!(scale > 0.0)) {
    visit(0.0);
    return;
  }
  Polynomial<kDegree> balanced;
  double power = 1.0;
  for (int k = kDegree; k >= 0; --k) {
    balanced[k] = c[k] / c[kDegree] / power;
    power *= scale;
  }
  constexpr double kBound = 2.0;  // Fujiwara's bound, above
  const auto roots = real_roots_detail::roots_within<kDegree>(balanced, kBound);
  for (std::size_t i = 0; i < roots.count; ++i) {
    visit(scale * roots.x[i]);
  }
}

}  // namespace palpate
