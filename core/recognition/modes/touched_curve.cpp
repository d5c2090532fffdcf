#include "core/recognition/modes/touched_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <variant>

#include "core/curves/curve.h"
#include "core/recognition/fit/orthogonal/measured_normal.h"
#include "core/recognition/modes/reference_point.h"
#include "core/recognition/modes/touched_arc.h"
#include "core/recognition/modes/touched_points.h"

namespace palpate {
namespace {

/// How the shape, the place and the tangent there move with each coordinate of the shape, by
/// central differences.
struct Motions {
  Eigen::Matrix<double, 3, 4> shape = Eigen::Matrix<double, 3, 4>::Zero();
  Eigen::RowVector4d t = Eigen::RowVector4d::Zero();
  Eigen::RowVector4d turn = Eigen::RowVector4d::Zero();
};

std::optional<Motions> motions_at(const Touch& touch, const TouchedVector& z) {
  constexpr double kStep = 1e-5;  // errors of 1e-10 and of rounding, 1e-11
  Motions motions;
  const int own = shape_coordinates(touch.curve_class);
  for (int k = 0; k < own; ++k) {
    std::array<TouchedShape, 2> ends;
    std::array<Vec2, 2> tangents;
    double width = 0.0;
    for (const int side : {0, 1}) {
      TouchedVector there = z;
      there[k] += side == 0 ? -kStep : kStep;
      auto shape = shape_at(touch.chart(), there, touch.shape);
      const bool outside = !shape;
      if (outside) {
        shape = shape_at(touch.chart(), z, touch.shape);  // one-sided at the class's limit
      }
      const auto curve = shape ? make_curve(touch.curve_class, shape->values) : std::nullopt;
      if (!curve) {
        return std::nullopt;
      }
      width += outside ? 0.0 : kStep;
      ends[static_cast<std::size_t>(side)] = *shape;
      tangents[static_cast<std::size_t>(side)] = derivatives(*curve, shape->t).first;
    }
    if (!(width > 0.0)) {
      return std::nullopt;
    }
    motions.shape.col(k) = (ends[1].values - ends[0].values) / width;
    // Eccentric angles may wrap.
    const double dt = touch.curve_class == CurveClass::Ellipse ? wrap_angle(ends[1].t - ends[0].t)
                                                               : ends[1].t - ends[0].t;
    motions.t[k] = dt / width;
    motions.turn[k] =
        std::atan2(cross(tangents[0], tangents[1]), tangents[0].dot(tangents[1])) / width;
  }
  return motions;
}

/// How position_by_parameters changes along the curve, by central differences.
Eigen::Matrix<double, 2, 3> shape_rate(const Curve& curve, double t) {
  const double step = 1e-5 * std::max(1.0, std::abs(t));
  return (position_by_parameters(curve, t + step) - position_by_parameters(curve, t - step)) /
         (2.0 * step);
}

/// How a place of the curve moves with the parameters. That of a conic moves in proportion to its
/// coordinates: no function of t is asked again.
template <PlaneCurve C>
auto place_by_parameters(const C& curve, const TrialFoot& foot) {
  return curve.position_by_parameters(foot.t);
}
Vec2 place_by_parameters(const Circle& circle, const TrialFoot& foot) {
  return foot.position / circle.a;
}
Vec2 place_by_parameters(const Parabola& parabola, const TrialFoot& foot) {
  return foot.position / parabola.a;
}
Eigen::Matrix2d place_by_parameters(const Ellipse& ellipse, const TrialFoot& foot) {
  return Vec2(foot.position.x() / ellipse.a, foot.position.y() / ellipse.b).asDiagonal();
}
Eigen::Matrix2d place_by_parameters(const Hyperbola& hyperbola, const TrialFoot& foot) {
  return Vec2(foot.position.x() / hyperbola.a, foot.position.y() / hyperbola.b).asDiagonal();
}

/// What a coordinate of the shape moves of a curve's places, relative to the touched place and its
/// tangent, which stay.
struct Moving {
  Motions motions;
  CurveDerivatives at;  ///< the touched place, in the curve's own frame
  Eigen::Matrix<double, 2, 3> by_shape_at;
};

/// add_points of a class in its own coordinates.
template <PlaneCurve C>
bool add_points_of(const Touch& touch, const FitData& data, const C& canonical,
                   const Moving& moving, TouchedCurve* curve) {
  const Motions& motions = moving.motions;
  const CurveDerivatives& at = moving.at;
  // By a coordinate of the shape, a place moves by its own part and, with the touched place, by
  // -shift - turn * lever.
  const Eigen::Matrix<double, 2, 4> shift =
      moving.by_shape_at * motions.shape + at.first * motions.t;
  const Eigen::Matrix<double, C::parameter_count, 4> shape =
      motions.shape.template topRows<C::parameter_count>();
  const auto row_of = [&](const TrialFoot& foot, const Vec2& normal,
                          double lever) -> Eigen::Vector4d {
    const auto by_shape = (normal.transpose() * place_by_parameters(canonical, foot)).eval();
    return (by_shape * shape - normal.transpose() * shift - lever * motions.turn).transpose();
  };
  return add_points(touch, data, canonical, at.position, row_of, curve);
}

/// Feet, chi-square and derivatives of `curve`, whose z, shape and starting t are set.
bool place_on(const Touch& touch, const FitData& data, TouchedCurve* curve) {
  const auto canonical = make_curve(touch.curve_class, curve->shape.values);
  const auto motions = motions_at(touch, curve->z);
  if (!canonical || !motions) {
    return false;
  }
  const CurveDerivatives at = derivatives(*canonical, curve->shape.t);
  if (!(at.first.norm() > 0.0)) {
    return false;  // the cusp itself has no tangent
  }
  curve->frame_T_curve = pose_of(touch, curve->z, *canonical, curve->shape.t);
  set_prior(touch, curve);
  const Moving moving{*motions, at, position_by_parameters(*canonical, curve->shape.t)};
  const bool placed = std::visit(
      [&](const auto& c) { return add_points_of(touch, data, c, moving, curve); }, *canonical);
  if (!placed) {
    return false;
  }
  if (!touch.normal_weights.empty()) {
    const auto turn_by = [&](int k, double t, const CurveDerivatives& foot,
                             const NormalAtFoot& there, const Vec2& lever) {
      const Eigen::Matrix<double, 2, 3> by_shape =
          position_by_parameters(*canonical, t) - moving.by_shape_at;
      return there.turn_by(
          by_shape * motions->shape.col(k) - motions->turn[k] * lever - motions->t[k] * at.first,
          shape_rate(*canonical, t) * motions->shape.col(k) -
              motions->turn[k] * left_of(foot.first));
    };
    add_normals(
        touch, data, at.position, [&](double t) { return derivatives(*canonical, t); }, turn_by,
        curve);
  }
  return std::isfinite(curve->chi2) && curve->root.allFinite();
}

}  // namespace

Pose2 pose_of(const Touch& touch, const TouchedVector& z, const Curve& curve, double t) {
  const int own = shape_coordinates(touch.curve_class);
  const CurveDerivatives at = derivatives(curve, t);
  return pose_carrying(turn_between(at.first, touch.tangent) + z[own + 1], at.position,
                       touch.place + z[own] * left_of(touch.tangent));
}

std::optional<Touch> touch_of(const CanonicalFit& fit, const FitData& data) {
  Touch touch;
  touch.curve_class = fit.shape.curve_class;
  touch.shape = normalised_shape(
      touch.curve_class, {fit.shape.values, fit.points[reference_point(data)].t}, data.scale);
  const auto curve = make_curve(touch.curve_class, touch.shape.values);
  if (!curve) {
    return std::nullopt;
  }
  const CurveDerivatives at = derivatives(*curve, touch.shape.t);
  const double speed = at.first.norm();
  // A fit so far from its vertex that rounding moves places by a thousandth of their extent tells
  // nothing, though its residuals may be 0.
  constexpr double kFarthest = 1e-3 / std::numeric_limits<double>::epsilon();
  if (!(speed > 0.0) || !(at.position.norm() < kFarthest)) {
    return std::nullopt;
  }
  const Pose2 pose = data.frame.inverse() * fit.world_T_curve;
  touch.place = pose.rotate(at.position) + pose.translation() / data.scale;
  touch.tangent = pose.rotate(at.first / speed);
  set_normal_weights(fit, data, &touch);
  return touch;
}

Touch along_patch(Touch touch, const FitData& data) {
  const std::size_t at = reference_point(data);
  const auto patch = std::find_if(data.patches.begin(), data.patches.end(),
                                  [&](const PatchSpan& p) { return at >= p.begin && at < p.end; });
  const std::size_t before = std::max(at, patch->begin + 1) - 1;
  const std::size_t after = std::min(at + 1, patch->end - 1);
  const Vec2 along = data.points[after].position - data.points[before].position;
  if (!(along.squaredNorm() > 0.0)) {
    return touch;
  }
  touch.place = data.points[at].position;
  touch.tangent = std::copysign(1.0, along.dot(touch.tangent)) * along.normalized();
  return touch;
}

std::optional<TouchedCurve> curve_at(const Touch& touch, const CanonicalFit& fit,
                                     const FitData& data) {
  TouchedCurve curve;
  curve.z = coordinates_of(touch.chart(), touch.shape);
  curve.shape = touch.shape;
  curve.t.reserve(data.points.size());
  for (const FittedPoint& point : fit.points) {
    curve.t.push_back(
        normalised_shape(touch.curve_class, {fit.shape.values, point.t}, data.scale).t);
  }
  if (!touch.as_arc) {
    return place_on(touch, data, &curve) ? std::optional(std::move(curve)) : std::nullopt;
  }
  const auto spline = make_curve(touch.curve_class, touch.shape.values);
  if (!spline) {
    return std::nullopt;
  }
  to_arc_feet(*spline, touch.shape.t, &curve.t);
  return place_arc_on(touch, data, &curve) ? std::optional(std::move(curve)) : std::nullopt;
}

std::optional<TouchedCurve> curve_at(const Touch& touch, const TouchedVector& z,
                                     const TouchedCurve& from, const FitData& data) {
  TouchedCurve curve;
  curve.z = z;
  curve.t = from.t;  // of an arc: as far from the touched place
  if (touch.as_arc) {
    return place_arc_on(touch, data, &curve) ? std::optional(std::move(curve)) : std::nullopt;
  }
  const auto shape = shape_at(touch.chart(), z, touch.shape);
  if (!shape) {
    return std::nullopt;
  }
  curve.shape = *shape;
  return place_on(touch, data, &curve) ? std::optional(std::move(curve)) : std::nullopt;
}

std::optional<TouchedCurve> in_canonical_form(const Touch& touch, TouchedCurve curve) {
  if (!touch.as_arc) {
    return curve;
  }
  const auto shape = shape_at(touch.chart(), curve.z, touch.shape);
  const auto canonical = shape ? make_curve(touch.curve_class, shape->values) : std::nullopt;
  if (!canonical) {
    return std::nullopt;
  }
  curve.shape = *shape;
  curve.frame_T_curve = pose_of(touch, curve.z, *canonical, shape->t);
  const double speed = derivatives(*canonical, shape->t).first.norm();
  for (double& t : curve.t) {
    t = shape->t + t / speed;
  }
  return curve;
}

}  // namespace palpate
