#include "sim/shape.h"

#include <algorithm>
#include <cmath>

#include "core/curves/arc_length.h"

namespace palpate::sim {
namespace {

template <typename... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <typename... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

/// Arc length over a shape that is smooth between joints at whole numbers of t, or everywhere.
double arc_length(const Shape& shape, double t0, double t1) {
  const auto speed = [&](double t) { return point_at(shape, t).first.norm(); };
  if (!std::holds_alternative<ClosedSpline>(shape)) {
    return integrate_speed(speed, t0, t1);
  }
  if (t1 < t0) {
    return -arc_length(shape, t1, t0);
  }
  double sum = 0.0;
  for (double from = t0; from < t1;) {
    const double to = std::min(std::floor(from) + 1.0, t1);
    sum += integrate_speed(speed, from, to);
    from = to;
  }
  return sum;
}

}  // namespace

ShapePoint point_at(const Shape& shape, double t) {
  return std::visit(Overloaded{[t](const Curve& curve) {
                                 const CurveDerivatives d = derivatives(curve, t);
                                 return ShapePoint{d.position, d.first, d.second};
                               },
                               [t](const auto& other) { return other.point_at(t); }},
                    shape);
}

double curvature(const ShapePoint& point) {
  const double speed = point.first.norm();
  return cross(point.first, point.second) / (speed * speed * speed);
}

double parameter_at_arc_length(const Shape& shape, double t0, double s) {
  if (const auto* curve = std::get_if<Curve>(&shape)) {
    return palpate::parameter_at_arc_length(*curve, t0, s);
  }
  const double speed = point_at(shape, t0).first.norm();
  return invert_arc_length([&](double from, double to) { return arc_length(shape, from, to); },
                           [&](double t) { return point_at(shape, t).first.norm(); }, t0, s,
                           std::abs(s) / speed);
}

std::optional<ClassifiedPiece> classified_piece(const Shape& shape, double t0, double t1) {
  if (const auto* curve = std::get_if<Curve>(&shape)) {
    return ClassifiedPiece{*curve, {}};
  }
  const auto* spline = std::get_if<ClosedSpline>(&shape);
  if (spline == nullptr) {
    return std::nullopt;
  }
  const double lower = std::min(t0, t1);
  const double upper = std::max(t0, t1);
  if (upper > std::floor(lower) + 1.0) {
    return std::nullopt;
  }
  const auto segment = spline->canonical_segment(spline->segment_at(lower));
  if (!segment) {
    return std::nullopt;
  }
  return ClassifiedPiece{segment->curve, segment->shape_T_curve};
}

}  // namespace palpate::sim
