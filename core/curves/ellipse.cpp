#include "core/curves/ellipse.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/curves/arc_length.h"
#include "core/curves/foot_point.h"

namespace palpate {
namespace {

/// The angle t of the foot, for a point in the first quadrant. The foot is (a^2 x / (l + a^2), b^2
/// y / (l + b^2)), where l is the Lagrange multiplier that puts it on the ellipse, the only one
/// above -b^2 (D. Eberly, "Distance from a point to an ellipse"). With z = 1 + l/b^2 as the unknown
/// nothing cancels, neither near a circle (e -> 0) nor near the major axis (z -> 0).
double first_quadrant_angle(double a, double b, double x, double y) {
  const double focal2 = (a - b) * (a + b);
  if (y == 0.0) {
    // The vertex; or, for a point inside the cusp of the evolute at focal2 / a, a foot off the
    // vertex.
    const double cosine = a * x < focal2 ? a * x / focal2 : 1.0;
    return std::atan2(std::sqrt((1.0 - cosine) * (1.0 + cosine)), cosine);
  }
  const double e = focal2 / (b * b);
  const double nx = a * x / (b * b);
  const double ny = y / b;
  // (nx / (z + e))^2 + (ny / z)^2 - 1 is decreasing and convex for z > 0: from a start with a value
  // >= 0 Newton's method rises to the root and never passes it.
  double z = std::max(ny, nx - e);
  constexpr int kMostIterations = 100;  // growth by 1.5 at worst, from rounding to 1
  for (int i = 0; i < kMostIterations; ++i) {
    const double c = nx / (z + e);
    const double s = ny / z;
    const double slope = -2.0 * (c * c / (z + e) + s * s / z);
    const double next = z - (c * c + s * s - 1.0) / slope;
    if (!(next > z)) {
      break;
    }
    z = next;
  }
  return std::atan2(ny / z, nx / (z + e));
}

/// Perimeter by the arithmetic-geometric mean: 2 pi (a^2 - sum 2^(n-1) c_n^2) / M(a, b).
double perimeter(double a, double b) {
  double mean = a;
  double geometric = b;
  double weight = 0.5;
  double sum = a * a - weight * (a - b) * (a + b);
  // Each step takes the root of a/b, then converges quadratically.
  constexpr int kMostIterations = 40;
  for (int i = 0; i < kMostIterations; ++i) {
    const double difference = 0.5 * (mean - geometric);
    if (!(difference > std::numeric_limits<double>::epsilon() * mean)) {
      break;
    }
    const double next = 0.5 * (mean + geometric);
    geometric = std::sqrt(mean * geometric);
    mean = next;
    weight *= 2.0;
    sum -= weight * difference * difference;
  }
  return 2.0 * kPi * sum / mean;
}

}  // namespace

bool Ellipse::is_valid() const { return std::isfinite(a) && b > 0.0 && a >= b; }

Vec2 Ellipse::position(double t) const { return {a * std::cos(t), b * std::sin(t)}; }

CurveDerivatives Ellipse::derivatives(double t) const {
  const double c = std::cos(t);
  const double s = std::sin(t);
  return {{a * c, b * s}, {-a * s, b * c}, {-a * c, -b * s}, {a * s, -b * c}};
}

LocalGeometry Ellipse::geometry(double t) const {
  const double c = std::cos(t);
  const double s = std::sin(t);
  const double speed2 = a * a * s * s + b * b * c * c;
  return {std::atan2(b * c, -a * s), a * b / (speed2 * std::sqrt(speed2)),         // (20)
          -3.0 * a * b * (a - b) * (a + b) * s * c / (speed2 * speed2 * speed2)};  // (21)
}

Eigen::Matrix<double, 2, 2> Ellipse::position_by_parameters(double t) const {
  Eigen::Matrix<double, 2, 2> m;
  m << std::cos(t), 0.0, 0.0, std::sin(t);
  return m;
}

FootPoint Ellipse::foot_point(const Vec2& point) const {
  if (!point.allFinite()) {
    return no_foot_point(*this);
  }
  double t = first_quadrant_angle(a, b, std::abs(point.x()), std::abs(point.y()));
  t = point.x() < 0.0 ? kPi - t : t;
  t = point.y() < 0.0 ? -t : t;
  return foot_point_at(*this, t, point);
}

double Ellipse::speed(double t) const {
  const double x = a * std::sin(t);
  const double y = b * std::cos(t);
  return std::sqrt(x * x + y * y);
}

double Ellipse::arc_length(double t0, double t1) const {
  // Whole turns have a closed form. The rest is integrated in pieces that end at the vertices,
  // because the speed of a slender ellipse has its singularities near them.
  const double turns = std::trunc((t1 - t0) / (2.0 * kPi));
  const double end = t1 - 2.0 * kPi * turns;
  double length = turns != 0.0 ? turns * perimeter(a, b) : 0.0;
  const double low = std::min(t0, end);
  const double high = std::max(t0, end);
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  const auto speed_at = [this](double u) { return speed(u); };
  double sum = 0.0;
  for (double u = low; u < high;) {
    // The next multiple of pi/2; if rounding leaves no step to it, the end of the arc.
    const double vertex = 0.5 * kPi * (std::floor(u / (0.5 * kPi)) + 1.0);
    const double v = vertex > u ? std::min(vertex, high) : high;
    // Next to half a turn the sine has the rounding of t.
    const double rounding = a * kEpsilon * std::max(std::abs(u), std::abs(v));
    sum += integrate_speed(speed_at, u, v, rounding);
    u = v;
  }
  return length + (end < t0 ? -sum : sum);
}

double Ellipse::parameter_at_arc_length(double t0, double s) const {
  // Whole turns first, so that Newton's method stays within one turn.
  const double turns = std::trunc(s / perimeter(a, b));
  const double rest = s - turns * perimeter(a, b);
  return 2.0 * kPi * turns +
         invert_arc_length([this](double u, double v) { return arc_length(u, v); },
                           [this](double u) { return speed(u); }, t0, rest, 0.25 * kPi);
}

ParameterDomain Ellipse::domain() const { return {-kPi, kPi, 2.0 * kPi}; }

std::optional<Localisation> Ellipse::localise(const LocalGeometry& local) const {
  const double focal2 = (a - b) * (a + b);
  if (!is_finite(local) || local.kappa == 0.0 || focal2 == 0.0) {
    return std::nullopt;
  }
  const double cube_root = std::cbrt(a * b / std::abs(local.kappa));
  const double d = cube_root * cube_root;  // squared speed at the point
  const double sin_2t = -2.0 * local.kappa_s * d * d * d / (3.0 * a * b * focal2);
  const double cos_2t = ((a * a - d) + (b * b - d)) / focal2;
  return finite_place(0.5 * std::atan2(sin_2t, cos_2t), local.kappa > 0.0);
}

}  // namespace palpate
