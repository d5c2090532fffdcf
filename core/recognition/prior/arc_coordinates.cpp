#include "core/recognition/prior/arc_coordinates.h"

#include <cmath>
#include <limits>

#include "core/curves/pose2.h"

namespace palpate {

ArcCoordinates arc_coordinates_of(const TouchedShape& spline) {
  const double a = spline.values[0];
  const double b = spline.values[1];
  const double t = spline.t;
  const Vec2 first(2.0 * t, (3.0 * a * t + 2.0 * b) * t + spline.values[2]);
  const double speed = first.norm();
  const Vec2 tangent = first / speed;
  const Vec2 normal = left_of(tangent);
  const Vec2 second = Vec2(2.0, 6.0 * a * t + 2.0 * b) / (speed * speed);
  const Vec2 third = Vec2(0.0, 6.0 * a) / (speed * speed * speed);
  return {second.dot(tangent), second.dot(normal), third.dot(tangent), third.dot(normal)};
}

namespace {

/// The third derivative has the direction of y; x has none of it, and its second derivative by t is
/// 2.
struct Axes {
  double third;  ///< its length
  Vec2 y;
  Vec2 x;
  double x_second;

  explicit Axes(const ArcCoordinates& z)
      : third(z.tail<2>().norm()),
        y(z.tail<2>() / third),
        x(-left_of(y)),
        x_second(Vec2(z.head<2>()).dot(x)) {}

  bool is_spline() const { return third > 0.0 && x_second > 0.0; }
};

}  // namespace

bool is_spline(const ArcCoordinates& z) { return Axes(z).is_spline(); }

std::optional<TouchedShape> spline_at(const ArcCoordinates& z) {
  const Axes axes(z);
  if (!axes.is_spline()) {
    return std::nullopt;
  }
  const double rate = std::sqrt(2.0 / axes.x_second);  // of s by t
  TouchedShape spline;
  spline.t = 0.5 * rate * axes.x.x();
  const double a = rate * rate * rate * axes.third / 6.0;
  const double b = 0.5 * rate * rate * Vec2(z.head<2>()).dot(axes.y) - 3.0 * a * spline.t;
  const double c = rate * axes.y.x() - (3.0 * a * spline.t + 2.0 * b) * spline.t;
  spline.values << a, b, c;
  // Near a cubical parabola x, y are small differences of large terms. Rounding moves places by no
  // more than a thousandth of the touched extent.
  constexpr double kMostTerms = 1e-3 / std::numeric_limits<double>::epsilon();
  const double t = std::abs(spline.t);
  const double terms = ((a * t + std::abs(b) + 1.0) * t + std::abs(c)) * t;
  return terms < kMostTerms ? std::optional(spline) : std::nullopt;
}

// A part is 1 to 20 half extents of what is touched, sqrt(20) half way. Each term of the series
// moves the end of an arc that is as long by about as much: s^2 / 2 z = s, s^3 / 6 z = s. Parts of
// size S are expected as its square or its inverse square: the tails are those powers.
StudentLaw law_of_arc(int k) {
  constexpr double kSize2 = 20.0;
  static const StudentLaw second{2, 2.0 / std::sqrt(kSize2)};
  static const StudentLaw third{1, 6.0 / kSize2};
  return k < 2 ? second : third;
}

// Inflections: 3 (a t)^2 = a c.
bool is_seen_as_arc(double place_from_vertex, double bend) {
  return 4.0 * bend > 3.0 * place_from_vertex * place_from_vertex;
}

}  // namespace palpate
