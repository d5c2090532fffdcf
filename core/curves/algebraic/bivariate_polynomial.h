// Polynomials in x and y: algebraic curves f(x, y) = 0.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/curves/pose2.h"

namespace palpate {

/// All partial derivatives to third order. `size`: sum of the moduli of the terms of f,
/// gradient_size of those of its first derivatives (the larger one): what rounding is to be
/// compared with.
struct PlaneJet {
  double f = 0.0;
  Vec2 gradient = Vec2::Zero();
  double xx = 0.0, xy = 0.0, yy = 0.0;
  double xxx = 0.0, xxy = 0.0, xyy = 0.0, yyy = 0.0;
  double size = 0.0;
  double gradient_size = 0.0;
};

/// f(x, y) = sum c_ij u^i v^j over i + j <= degree, (u, v) = ((x, y) - origin) / scale: an origin
/// near the curve and a scale of its size keep the terms from cancelling.
class BivariatePolynomial {
 public:
  explicit BivariatePolynomial(int degree, const Vec2& origin_m = Vec2::Zero(),
                               double scale_m = 1.0);

  int degree() const { return degree_; }
  const Vec2& origin() const { return origin_; }
  double scale() const { return scale_; }

  /// The coefficient of u^i v^j; i, j >= 0, i + j <= degree.
  double& coefficient(int i, int j) { return coefficients_[index(i, j)]; }
  double coefficient(int i, int j) const { return coefficients_[index(i, j)]; }

  double operator()(const Vec2& point_m) const;

  /// Derivatives by x and y. O(degree^2).
  PlaneJet jet(const Vec2& point_m) const;

  /// Sum and product; origin and scale must be the same.
  BivariatePolynomial operator+(const BivariatePolynomial& other) const;
  BivariatePolynomial operator*(const BivariatePolynomial& other) const;
  BivariatePolynomial operator*(double factor) const;

 private:
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(degree_ + 1) +
           static_cast<std::size_t>(j);
  }

  int degree_;
  Vec2 origin_;
  double scale_;
  std::vector<double> coefficients_;  ///< square array; i + j > degree is not used
};

}  // namespace palpate
