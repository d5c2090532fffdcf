#include "sim/closed_spline.h"

#include <cmath>
#include <utility>

namespace palpate::sim {

ClosedSpline::ClosedSpline(std::vector<Vec2> control_points) : points_(std::move(control_points)) {}

std::size_t ClosedSpline::segment_at(double t) const {
  const auto count = static_cast<double>(size());
  const double within = t - count * std::floor(t / count);
  // Rounding can make `within` equal to the count.
  return static_cast<std::size_t>(within) % size();
}

ClosedSpline::Cubic ClosedSpline::cubic(std::size_t segment) const {
  const Vec2& p0 = points_[segment % size()];
  const Vec2& p1 = points_[(segment + 1) % size()];
  const Vec2& p2 = points_[(segment + 2) % size()];
  const Vec2& p3 = points_[(segment + 3) % size()];
  return {(p3 - p0 + 3.0 * (p1 - p2)) / 6.0, (p0 - 2.0 * p1 + p2) / 2.0, (p2 - p0) / 2.0,
          (p0 + 4.0 * p1 + p2) / 6.0};
}

ShapePoint ClosedSpline::point_at(double t) const {
  const Cubic c = cubic(segment_at(t));
  const double u = t - std::floor(t);
  return {((c.third * u + c.second) * u + c.first) * u + c.zeroth,
          (3.0 * c.third * u + 2.0 * c.second) * u + c.first, 6.0 * c.third * u + 2.0 * c.second};
}

std::optional<ClosedSpline::Canonical> ClosedSpline::canonical_segment(std::size_t segment) const {
  const Cubic c = cubic(segment);
  const double third = c.third.norm();
  if (!(third > 0.0)) {
    return std::nullopt;
  }
  // The cubic part points along y, so that x is quadratic in u.
  Vec2 y_axis = c.third / third;
  Vec2 x_axis = -left_of(y_axis);
  double alpha = x_axis.dot(c.second);
  if (alpha < 0.0) {
    alpha = -alpha;
    x_axis = -x_axis;
    y_axis = -y_axis;
  }
  if (!(alpha > 1e-12 * third)) {
    return std::nullopt;
  }
  // x = alpha u^2 + beta u + ... = t^2 + x0 with t = root u + shift.
  const double root = std::sqrt(alpha);
  const double beta = x_axis.dot(c.first);
  const double shift = beta / (2.0 * root);
  const double x0 = x_axis.dot(c.zeroth) - shift * shift;
  // y, a cubic in u = (t - shift) / root, by powers of t.
  const double y3 = y_axis.dot(c.third) / (root * alpha);
  const double y2 = y_axis.dot(c.second) / alpha;
  const double y1 = y_axis.dot(c.first) / root;
  double a = y3;
  const double b = y2 - 3.0 * y3 * shift;
  double coefficient_c = (3.0 * y3 * shift - 2.0 * y2) * shift + y1;
  const double y0 = ((-y3 * shift + y2) * shift - y1) * shift + y_axis.dot(c.zeroth);
  if (a < 0.0) {  // t -> -t
    a = -a;
    coefficient_c = -coefficient_c;
  }
  const Vec2 origin = x0 * x_axis + y0 * y_axis;
  const CubicSpline curve{a, b, coefficient_c};
  if (!curve.is_valid()) {
    return std::nullopt;
  }
  return Canonical{curve, {origin.x(), origin.y(), std::atan2(x_axis.y(), x_axis.x())}};
}

}  // namespace palpate::sim
