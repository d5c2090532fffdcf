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

}  // namespace

ShapePoint point_at(const Shape& shape, double t) {
  const auto point = [](const CurveDerivatives& d) {
    return ShapePoint{d.position, d.first, d.second};
  };
  return std::visit(
      Overloaded{[&](const Curve& curve) { return point(derivatives(curve, t)); },
                 [&](const ClosedSpline& spline) { return point(spline.derivatives(t)); },
                 [t](const auto& other) { return other.point_at(t); }},
      shape);
}

double curvature(const ShapePoint& point) {
  const double speed = point.first.norm();
  return cross(point.first, point.second) / (speed * speed * speed);
}

double parameter_at_arc_length(const Shape& shape, double t0, double s) {
  return std::visit(
      Overloaded{[&](const Curve& curve) { return palpate::parameter_at_arc_length(curve, t0, s); },
                 [&](const ClosedSpline& spline) { return spline.parameter_at_arc_length(t0, s); },
                 [&](const auto& other) {
                   const auto speed = [&](double t) { return other.point_at(t).first.norm(); };
                   return invert_arc_length(
                       [&](double from, double to) {
                         return integrate_speed(speed, from, to, 0.0);
                       },
                       speed, t0, s, std::abs(s) / speed(t0));
                 }},
      shape);
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
