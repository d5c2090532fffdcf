// Sums and products of doubles in twice their precision (error-free transformations of Knuth and
// Dekker). For the few values in this library where digits cancel: a conic at its own centre,
// nearly parallel vectors.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace palpate {

/// high + low with |low| <= half a unit in the last place of high. The relative error of a product,
/// or of a sum of numbers with equal sign, is a few 2^-104. Not for values that overflow or whose
/// product underflows.
struct DoubleDouble {
  double high = 0.0;
  double low = 0.0;

  constexpr DoubleDouble() = default;
  constexpr DoubleDouble(double value) : high(value) {}
  constexpr DoubleDouble(double high_part, double low_part) : high(high_part), low(low_part) {}

  explicit operator double() const { return high + low; }

  friend DoubleDouble operator+(const DoubleDouble& u, const DoubleDouble& v) {
    const double sum = u.high + v.high;
    const double part = sum - u.high;
    const double error = (u.high - (sum - part)) + (v.high - part);
    return normalised(sum, error + (u.low + v.low));
  }

  friend DoubleDouble operator*(const DoubleDouble& u, const DoubleDouble& v) {
    const double product = u.high * v.high;
    const double error = std::fma(u.high, v.high, -product);
    return normalised(product, error + (u.high * v.low + u.low * v.high));
  }

  friend DoubleDouble operator-(const DoubleDouble& u) { return {-u.high, -u.low}; }
  friend DoubleDouble operator-(const DoubleDouble& u, const DoubleDouble& v) { return u + (-v); }

 private:
  /// Precondition: |high_part| >= |low_part|.
  static DoubleDouble normalised(double high_part, double low_part) {
    const double sum = high_part + low_part;
    return {sum, low_part - (sum - high_part)};
  }
};

/// a d - b c, with an error of at most 1.5 units in the last place, however much cancels.
inline double difference_of_products(double a, double d, double b, double c) {
  // Kahan's algorithm.
  const double bc = b * c;
  const double rounding = std::fma(-b, c, bc);
  return std::fma(a, d, -bc) + rounding;
}

/// z component of u x v, correct to the last place even for nearly parallel vectors.
inline double accurate_cross(const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
  return difference_of_products(u.x(), v.y(), u.y(), v.x());
}

/// u . v, correct to the last place.
inline double accurate_dot(const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
  return difference_of_products(u.x(), v.x(), -u.y(), v.y());
}

}  // namespace palpate
