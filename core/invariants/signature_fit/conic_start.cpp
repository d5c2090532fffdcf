#include "core/invariants/signature_fit/conic_start.h"

#include <cassert>
#include <cmath>
#include <utility>

#include "core/curves/pose2.h"
#include "core/invariants/signature_fit/canonical_models.h"
#include "core/invariants/signature_fit/local_parameter.h"

namespace palpate {
namespace {

/// sin 2t = -2 kappa_s D^3 / (3 a b (a^2 - b^2)), cos 2t = (a^2 + b^2 - 2 D) / (a^2 - b^2) with D =
/// (a b / |kappa|)^(2/3). Well conditioned at the vertices, unlike the paper's arcsine. The common
/// denominator is omitted: near a circle both are noise, and so is t.
double ellipse_t(double a, double b, double kappa, double kappa_s) {
  const double ratio = a * b / kappa;
  const double root = std::cbrt(std::abs(ratio));
  return 0.5 * std::atan2(-2.0 * kappa_s * ratio * ratio / (3.0 * a * b),
                          a * a + b * b - 2.0 * root * root);
}

}  // namespace

double conic_orientation(CurveClass curve_class, const Eigen::Vector3d& p,
                         std::span<const MeasuredGeometry> points) {
  const double symmetry = pose_symmetry(curve_class);
  Vec2 sum = Vec2::Zero();
  for (const MeasuredGeometry& point : points) {
    double angle = 0.0;
    if (curve_class == CurveClass::Ellipse) {
      const double t = ellipse_t(p[0], p[1], point.kappa, point.kappa_s);
      angle = geometry_of(EllipseModel::derivatives(p.data(), t)).tangent_angle;
    } else {
      assert(curve_class == CurveClass::Parabola || curve_class == CurveClass::Hyperbola);
      const double forward =
          curve_class == CurveClass::Parabola
              ? geometry_of(ParabolaModel::derivatives(
                                p.data(), parabola_parameter(point.kappa, point.kappa_s)))
                    .tangent_angle
              : geometry_of(
                    HyperbolaModel::derivatives(
                        p.data(), hyperbola_parameter(p[0], p[1], point.kappa, point.kappa_s)))
                    .tangent_angle;
      // Both curves bend to the right for increasing t.
      angle = forward + (point.kappa > 0.0 ? kPi : 0.0);
    }
    const double multiple = symmetry * (point.tangent_angle - angle);
    sum += Vec2(std::cos(multiple), std::sin(multiple));
  }
  return std::atan2(sum.y(), sum.x()) / symmetry;
}

std::vector<CurveStart> conic_starts(CurveClass curve_class,
                                     std::span<const Eigen::Vector3d> shapes,
                                     std::span<const MeasuredGeometry> points) {
  // 30 degrees apart, 15 for the ellipse: Gauss-Newton covers half a step in one iteration. The
  // number of starts kept bounds the time.
  constexpr int kOrientations = 12;
  constexpr std::size_t kKept = 4;
  std::vector<CurveStart> starts;
  for (const Eigen::Vector3d& shape : shapes) {
    const double orientation = conic_orientation(curve_class, shape, points);
    for (int k = 0; k < kOrientations; ++k) {
      const double turn = 2.0 * kPi * k / (kOrientations * pose_symmetry(curve_class));
      starts.push_back({shape, orientation + turn});
    }
  }
  return best_starts(curve_class, points, std::move(starts), kKept);
}

}  // namespace palpate
