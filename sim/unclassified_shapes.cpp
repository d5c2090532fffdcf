#include "sim/unclassified_shapes.h"

#include <cmath>

namespace palpate::sim {
namespace {

/// The point r (cos t, sin t) from the polar radius r and its first two derivatives.
ShapePoint polar_point(double t, double r, double r1, double r2) {
  const Vec2 radial(std::cos(t), std::sin(t));
  const Vec2 across = left_of(radial);
  return {r * radial, r1 * radial + r * across, (r2 - r) * radial + 2.0 * r1 * across};
}

}  // namespace

ShapePoint Superellipse::point_at(double t) const {
  const double n = exponent;
  const double u = std::cos(t) / a;
  const double v = std::sin(t) / b;
  const double u1 = -std::sin(t) / a;
  const double v1 = std::cos(t) / b;
  const auto power = [](double base, double e) { return std::pow(std::abs(base), e); };
  // r = f^(-1/n) with f = |u|^n + |v|^n; u'' = -u and v'' = -v.
  const double f = power(u, n) + power(v, n);
  const double f1 =
      n * (std::copysign(power(u, n - 1.0), u) * u1 + std::copysign(power(v, n - 1.0), v) * v1);
  const double f2 =
      n * (n - 1.0) * (power(u, n - 2.0) * u1 * u1 + power(v, n - 2.0) * v1 * v1) - n * f;
  const double r = std::pow(f, -1.0 / n);
  const double log1 = -f1 / (n * f);  // (log r)'
  const double log2 = -(f2 * f - f1 * f1) / (n * f * f);
  return polar_point(t, r, r * log1, r * (log2 + log1 * log1));
}

ShapePoint Sinusoid::point_at(double t) const {
  const double omega = 2.0 * kPi / wavelength;
  const double s = amplitude * std::sin(omega * t);
  return {{t, s}, {1.0, amplitude * omega * std::cos(omega * t)}, {0.0, -omega * omega * s}};
}

ShapePoint LogSpiral::point_at(double t) const {
  const double r = radius * std::exp(growth * t);
  return polar_point(t, r, growth * r, growth * growth * r);
}

}  // namespace palpate::sim
