#include "core/curves/algebraic/bivariate_polynomial.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace palpate {
namespace {

/// k-th derivative of t^n: value of the falling factorial, 0 for n < k.
double falling(int n, int k) {
  double product = 1.0;
  for (int i = 0; i < k; ++i) {
    product *= n - i;
  }
  return product;
}

}  // namespace

BivariatePolynomial::BivariatePolynomial(int degree, const Vec2& origin_m, double scale_m)
    : degree_(degree),
      origin_(origin_m),
      scale_(scale_m),
      coefficients_(static_cast<std::size_t>(degree + 1) * static_cast<std::size_t>(degree + 1)) {
  assert(degree >= 0 && scale_m > 0.0);
}

double BivariatePolynomial::operator()(const Vec2& point_m) const { return jet(point_m).f; }

PlaneJet BivariatePolynomial::jet(const Vec2& point_m) const {
  const Vec2 p = (point_m - origin_) / scale_;
  std::vector<double> u(static_cast<std::size_t>(degree_ + 1), 1.0);
  std::vector<double> v(u);
  for (std::size_t k = 1; k < u.size(); ++k) {
    u[k] = u[k - 1] * p.x();
    v[k] = v[k - 1] * p.y();
  }
  // By order of derivative in x and in y.
  double sums[4][4] = {};
  double sizes[4][4] = {};
  for (int i = 0; i <= degree_; ++i) {
    for (int j = 0; i + j <= degree_; ++j) {
      const double c = coefficient(i, j);
      if (c == 0.0) {
        continue;
      }
      for (int dx = 0; dx <= std::min(i, 3); ++dx) {
        for (int dy = 0; dy <= std::min(j, 3 - dx); ++dy) {
          const double term = c * falling(i, dx) * falling(j, dy) *
                              u[static_cast<std::size_t>(i - dx)] *
                              v[static_cast<std::size_t>(j - dy)];
          sums[dx][dy] += term;
          sizes[dx][dy] += std::abs(term);
        }
      }
    }
  }
  const double first = 1.0 / scale_;
  const double second = first * first;
  const double third = second * first;
  PlaneJet jet;
  jet.f = sums[0][0];
  jet.gradient = first * Vec2(sums[1][0], sums[0][1]);
  jet.xx = second * sums[2][0];
  jet.xy = second * sums[1][1];
  jet.yy = second * sums[0][2];
  jet.xxx = third * sums[3][0];
  jet.xxy = third * sums[2][1];
  jet.xyy = third * sums[1][2];
  jet.yyy = third * sums[0][3];
  jet.size = sizes[0][0];
  jet.gradient_size = first * std::max(sizes[1][0], sizes[0][1]);
  return jet;
}

BivariatePolynomial BivariatePolynomial::operator+(const BivariatePolynomial& other) const {
  assert(origin_ == other.origin_ && scale_ == other.scale_);
  BivariatePolynomial sum(std::max(degree_, other.degree_), origin_, scale_);
  for (const BivariatePolynomial* part : {this, &other}) {
    for (int i = 0; i <= part->degree_; ++i) {
      for (int j = 0; i + j <= part->degree_; ++j) {
        sum.coefficient(i, j) += part->coefficient(i, j);
      }
    }
  }
  return sum;
}

BivariatePolynomial BivariatePolynomial::operator*(const BivariatePolynomial& other) const {
  assert(origin_ == other.origin_ && scale_ == other.scale_);
  BivariatePolynomial product(degree_ + other.degree_, origin_, scale_);
  for (int i = 0; i <= degree_; ++i) {
    for (int j = 0; i + j <= degree_; ++j) {
      for (int k = 0; k <= other.degree_; ++k) {
        for (int l = 0; k + l <= other.degree_; ++l) {
          product.coefficient(i + k, j + l) += coefficient(i, j) * other.coefficient(k, l);
        }
      }
    }
  }
  return product;
}

BivariatePolynomial BivariatePolynomial::operator*(double factor) const {
  BivariatePolynomial scaled = *this;
  for (double& c : scaled.coefficients_) {
    c *= factor;
  }
  return scaled;
}

}  // namespace palpate
