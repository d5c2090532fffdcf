#include "tests/support/signature.h"

#include <cmath>

namespace palpate::test {
namespace {

double two_thirds(double x) {
  const double root = std::cbrt(std::abs(x));
  return root * root;
}

/// From u = |kappa|^(-2/3) at a vertex, where kappa_s = 0 and Ip = 1 / u.
ConicSignature through_vertex(double ic1, double u) { return {ic1, 1.0 / u + ic1 * u}; }

}  // namespace

double SignaturePoint::slope() const { return std::tan(tangent_angle); }

std::vector<SignaturePoint> signature_curve(const Curve& curve, double t0, double t1,
                                            std::size_t count) {
  std::vector<SignaturePoint> points;
  points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double t =
        count > 1 ? t0 + (t1 - t0) * static_cast<double>(i) / static_cast<double>(count - 1) : t0;
    const LocalGeometry local = geometry(curve, t);
    if (is_finite(local)) {
      points.push_back({t, local.tangent_angle, local.kappa, local.kappa_s});
    }
  }
  return points;
}

double ConicSignature::residual(double kappa, double kappa_s) const {
  if (kappa == 0.0) {
    return 1.0;
  }
  const double root = two_thirds(kappa);
  const double ratio = kappa_s / (3.0 * kappa * kappa);
  const double ip = root * (ratio * ratio + 1.0);
  if (!std::isfinite(ip)) {
    return 1.0;
  }
  const double slope_term = ic1 / root;
  return (ip + slope_term - ic2) / (ip + std::abs(slope_term) + std::abs(ic2));
}

std::optional<ConicSignature> conic_signature(const Curve& curve) {
  const Eigen::Vector3d p = parameters(curve);
  const double a = p[0];
  const double b = p[1];
  switch (class_of(curve)) {
    case CurveClass::Circle:
      return through_vertex(1.0 / two_thirds(a * a), two_thirds(a));
    case CurveClass::Ellipse:
      return through_vertex(1.0 / two_thirds(a * b), two_thirds(b * (b / a)));
    case CurveClass::Parabola:
      return through_vertex(0.0, two_thirds(2.0 * a));
    case CurveClass::Hyperbola:
      return through_vertex(-1.0 / two_thirds(a * b), two_thirds(b * (b / a)));
    default:
      return std::nullopt;
  }
}

}  // namespace palpate::test
