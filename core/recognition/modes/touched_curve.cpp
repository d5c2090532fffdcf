#include "core/recognition/modes/touched_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <variant>

#include "core/curves/curve.h"
#include "core/numerics/matrices/triangular_root.h"
#include "core/recognition/fit/orthogonal/measured_normal.h"
#include "core/recognition/modes/reference_point.h"
#include "core/recognition/modes/trial_foot.h"
#include "core/recognition/prior/touched_prior.h"

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

/// The place that was touched, in the curve's own frame, and how it moves.
struct Moving {
  Motions motions;
  CurveDerivatives at;
  Eigen::Matrix<double, 2, 3> by_shape_at;
};

/// How places of an arc move with each of its coordinates (arc_coordinates.h), and their
/// derivatives by t: the touched place and its tangent stay.
struct ArcMotions {
  Eigen::Matrix<double, 2, 4> of_place;
  Eigen::Matrix<double, 2, 4> by_t;
};

ArcMotions arc_motions(const CurveDerivatives& at, double t_from_touch) {
  const double speed = at.first.norm();
  const Vec2 tangent = at.first / speed;
  const double s = t_from_touch * speed;
  const double s2 = 0.5 * s * s;
  ArcMotions motions;
  motions.of_place << s2 * tangent, s2 * left_of(tangent), s / 3.0 * s2 * tangent,
      s / 3.0 * s2 * left_of(tangent);
  motions.by_t << s * tangent, s * left_of(tangent), s2 * tangent, s2 * left_of(tangent);
  motions.by_t *= speed;
  return motions;
}

/// The measured normals' part of chi-square and its derivatives, the feet found. On its own, so
/// that points without do not pay.
[[gnu::noinline]] void add_normals(const Touch& touch, const FitData& data, const Curve& canonical,
                                   const Moving& moving, TouchedCurve* curve) {
  const auto& [motions, at, by_shape_at] = moving;
  const int own = shape_coordinates(touch.curve_class);
  const Pose2& pose = curve->frame_T_curve;
  const Vec2 offset_direction = pose.rotate_back(left_of(touch.tangent));
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const double weight = touch.weight * touch.normal_weights[i];
    const CurveDerivatives foot = derivatives(canonical, curve->t[i]);
    const double speed = foot.first.norm();
    if (!(weight > 0.0) || !(speed > 0.0)) {
      continue;
    }
    const Vec2 normal = left_of(foot.first) / speed;
    const Vec2 away = pose.to_local(data.points[i].position) - foot.position;
    const NormalAtFoot there{normal, foot.first, foot.second, away.dot(normal)};
    const double residual = weight * normal_miss(pose.rotate_back(data.points[i].normal), normal);
    curve->chi2 += residual * residual;
    if (!there.is_followed()) {
      continue;
    }
    const Vec2 lever = left_of(foot.position - at.position);
    TouchedVector row = TouchedVector::Zero();
    if (touch.as_arc) {
      const ArcMotions of_arc = arc_motions(at, curve->t[i] - curve->shape.t);
      for (int k = 0; k < own; ++k) {
        row[k] = there.turn_by(of_arc.of_place.col(k), of_arc.by_t.col(k));
      }
    } else {
      const Eigen::Matrix<double, 2, 3> by_shape =
          position_by_parameters(canonical, curve->t[i]) - by_shape_at;
      const Eigen::Matrix<double, 2, 3> by_shape_and_t = shape_rate(canonical, curve->t[i]);
      for (int k = 0; k < own; ++k) {
        row[k] = there.turn_by(
            by_shape * motions.shape.col(k) - motions.turn[k] * lever - motions.t[k] * at.first,
            by_shape_and_t * motions.shape.col(k) - motions.turn[k] * left_of(foot.first));
      }
    }
    row[own] = there.turn_by(offset_direction, Vec2::Zero());
    row[own + 1] = there.turn_by(lever, left_of(foot.first));
    row = weight * row.cwiseProduct(curve->widths);
    Eigen::Matrix<double, 1, kMostCoordinates> one = row.transpose();
    absorb_rows(&one, &curve->root);
    curve->gradient += residual * row;
  }
}

/// Feet of the points, their part of chi-square and of its derivatives. `curve`: all but these set.
/// false if a foot has run away: no number tells how far the point is.
template <PlaneCurve C>
bool add_points(const Touch& touch, const FitData& data, const C& canonical, const Moving& moving,
                TouchedCurve* curve) {
  const auto& [motions, at, by_shape_at] = moving;
  const auto own = static_cast<Eigen::Index>(shape_coordinates(touch.curve_class));
  // By a coordinate of the shape, a place moves by its own part and, with the touched place, by
  // -shift - turn * lever.
  const Eigen::Matrix<double, 2, 4> shift = by_shape_at * motions.shape + at.first * motions.t;
  const Eigen::Matrix<double, C::parameter_count, 4> shape =
      motions.shape.template topRows<C::parameter_count>();
  const Vec2 offset_direction = curve->frame_T_curve.rotate_back(left_of(touch.tangent));
  const ToLocal to_local(curve->frame_T_curve);
  constexpr Eigen::Index kRows = 8;  // at a time
  Eigen::Matrix<double, kRows, kMostCoordinates> rows;
  rows.setZero();
  Eigen::Index r = 0;
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const Vec2 point = to_local(data.points[i].position);
    const double weight = touch.weight * data.points[i].inverse_sigma;
    const TrialFoot foot = trial_foot(canonical, point, curve->t[i], 1.0 / weight);
    curve->t[i] = foot.t;
    const Vec2 away = point - foot.position;
    const double foot_speed = foot.first.norm();
    if (!std::isfinite(foot_speed)) {
      return false;
    }
    // At a cusp the distance has no normal of the curve; it is its own.
    const Vec2 normal = foot_speed > 0.0    ? Vec2(left_of(foot.first) / foot_speed)
                        : !away.isZero(0.0) ? away.normalized()
                                            : Vec2(0.0, 1.0);
    const double residual = weight * away.dot(normal);
    curve->chi2 += residual * residual;
    const double lever = normal.dot(left_of(foot.position - at.position));
    TouchedVector row = TouchedVector::Zero();
    if (touch.as_arc) {
      row.head<4>() = arc_motions(at, foot.t - curve->shape.t).of_place.transpose() * normal;
    } else {
      const auto by_shape = (normal.transpose() * place_by_parameters(canonical, foot)).eval();
      row.head<4>() =
          (by_shape * shape - normal.transpose() * shift - lever * motions.turn).transpose();
    }
    row[own] = normal.dot(offset_direction);
    row[own + 1] = lever;
    row = -weight * row.cwiseProduct(curve->widths);
    curve->gradient += residual * row;
    rows.row(r) = row;
    if (++r == kRows) {
      absorb_rows(&rows, &curve->root);
      rows.setZero();
      r = 0;
    }
  }
  if (r > 0) {
    absorb_rows(&rows, &curve->root);
  }
  return true;
}

/// Where to seek the feet on an arc: as far from the touched place as they were on `from`. The
/// parameter of the spline that it is of changes with its coordinates, that length does not.
std::vector<double> moved_feet(const TouchedCurve& from, const TouchedShape& arc) {
  const auto speed_of = [](const TouchedShape& spline) {
    const auto curve = make_curve(CurveClass::CubicSpline, spline.values);
    return curve ? derivatives(*curve, spline.t).first.norm() : 0.0;
  };
  const double ratio = speed_of(from.shape) / speed_of(arc);
  std::vector<double> feet;
  feet.reserve(from.t.size());
  for (const double t : from.t) {
    feet.push_back(arc.t + ratio * (t - from.shape.t));
  }
  return feet;
}

/// Feet, chi-square and derivatives of `curve`, whose z, shape and starting t are set.
bool place_on(const Touch& touch, const FitData& data, TouchedCurve* curve) {
  const auto canonical = make_curve(touch.curve_class, curve->shape.values);
  const auto motions = touch.as_arc ? std::optional(Motions{}) : motions_at(touch, curve->z);
  if (!canonical || !motions) {
    return false;
  }
  const CurveDerivatives at = derivatives(*canonical, curve->shape.t);
  if (!(at.first.norm() > 0.0)) {
    return false;  // the cusp itself has no tangent
  }
  curve->frame_T_curve = pose_of(touch, curve->z, *canonical, curve->shape.t);
  curve->widths = prior_widths(touch.chart(), curve->z);
  curve->log_prior = log_prior(touch.chart(), curve->z);
  curve->chi2 = 0.0;
  const Moving moving{*motions, at, position_by_parameters(*canonical, curve->shape.t)};
  const bool placed = std::visit(
      [&](const auto& c) { return add_points(touch, data, c, moving, curve); }, *canonical);
  if (!placed) {
    return false;
  }
  if (!touch.normal_weights.empty()) {
    add_normals(touch, data, *canonical, moving, curve);
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
  if (residual_count(data) > data.points.size()) {
    for (const FittedPoint& point : fit.points) {
      touch.normal_weights.push_back(point.normal_weight);
    }
  }
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
  return place_on(touch, data, &curve) ? std::optional(std::move(curve)) : std::nullopt;
}

std::optional<TouchedCurve> curve_at(const Touch& touch, const TouchedVector& z,
                                     const TouchedCurve& from, const FitData& data) {
  const auto shape = shape_at(touch.chart(), z, touch.shape);
  if (!shape) {
    return std::nullopt;
  }
  TouchedCurve curve;
  curve.z = z;
  curve.shape = *shape;
  curve.t = touch.as_arc ? moved_feet(from, *shape) : from.t;
  return place_on(touch, data, &curve) ? std::optional(std::move(curve)) : std::nullopt;
}

}  // namespace palpate
