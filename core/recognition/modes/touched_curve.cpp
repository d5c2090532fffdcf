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
#include "core/recognition/prior/arc_coordinates.h"
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

/// What a coordinate of the shape moves of a curve's places, relative to the touched place and its
/// tangent, which stay.
struct Moving {
  Motions motions;
  CurveDerivatives at;  ///< the touched place, in the curve's own frame
  Eigen::Matrix<double, 2, 3> by_shape_at;
};

/// An arc in the frame of the touched place and its tangent (arc_coordinates.h), by s. Of a spline
/// beside a cubical parabola its places keep all digits, where the canonical form has its vertex
/// far away.
struct Arc {
  Vec2 second;
  Vec2 third;

  explicit Arc(const TouchedVector& z) : second(z.head<2>()), third(z.segment<2>(2)) {}

  CurveDerivatives derivatives(double s) const {
    const Vec2 bend = s * (second + 0.5 * s * third);
    return {Vec2(s, 0.0) + 0.5 * s * s * (second + s / 3.0 * third), Vec2::UnitX() + bend,
            second + s * third, third};
  }
};

/// How a place of an arc moves with each of its coordinates.
Eigen::Matrix<double, 2, 4> arc_motions(double s) {
  const double s2 = 0.5 * s * s;
  const double s3 = s / 3.0 * s2;
  Eigen::Matrix<double, 2, 4> motions;
  motions << s2, 0.0, s3, 0.0, 0.0, s2, 0.0, s3;
  return motions;
}

/// Their derivatives by s.
Eigen::Matrix<double, 2, 4> arc_motions_by_s(double s) {
  const double s2 = 0.5 * s * s;
  Eigen::Matrix<double, 2, 4> motions;
  motions << s, 0.0, s2, 0.0, 0.0, s, 0.0, s2;
  return motions;
}

/// The measured normals' part of chi-square and its derivatives, the feet found. On its own, so
/// that points without do not pay. `derivatives_at(t)`: of the curve; `touched`: the touched place
/// on it; `turn_by(k, t, foot, there, lever)`: by coordinate k of the shape.
template <typename DerivativesAt, typename TurnBy>
[[gnu::noinline]] void add_normals(const Touch& touch, const FitData& data, const Vec2& touched,
                                   const DerivativesAt& derivatives_at, const TurnBy& turn_by,
                                   TouchedCurve* curve) {
  const int own = shape_coordinates(touch.curve_class);
  const Pose2& pose = curve->frame_T_curve;
  const Vec2 offset_direction = pose.rotate_back(left_of(touch.tangent));
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const double weight = touch.weight * touch.normal_weights[i];
    const CurveDerivatives foot = derivatives_at(curve->t[i]);
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
    const Vec2 lever = left_of(foot.position - touched);
    TouchedVector row = TouchedVector::Zero();
    for (int k = 0; k < own; ++k) {
      row[k] = turn_by(k, curve->t[i], foot, there, lever);
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
/// `touched`: the touched place on the curve; `row_of(foot, normal, lever)`: how a foot moves along
/// the normal with the coordinates of the shape. false if a foot has run away: no number tells how
/// far the point is.
template <typename C, typename RowOf>
bool add_points(const Touch& touch, const FitData& data, const C& canonical, const Vec2& touched,
                const RowOf& row_of, TouchedCurve* curve) {
  const auto own = static_cast<Eigen::Index>(shape_coordinates(touch.curve_class));
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
    const double lever = normal.dot(left_of(foot.position - touched));
    TouchedVector row = TouchedVector::Zero();
    row.head<4>() = row_of(foot, normal, lever);
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

/// Prior of `curve`, whose z and frame are set.
void set_prior(const Touch& touch, TouchedCurve* curve) {
  curve->widths = prior_widths(touch.chart(), curve->z);
  curve->log_prior = log_prior(touch.chart(), curve->z);
  curve->chi2 = 0.0;
}

/// Feet, chi-square and derivatives of an arc, whose z and starting t are set.
bool place_arc_on(const Touch& touch, const FitData& data, TouchedCurve* curve) {
  if (!is_spline(curve->z.head<4>())) {
    return false;
  }
  const Arc arc(curve->z);
  const int own = shape_coordinates(touch.curve_class);
  curve->frame_T_curve =
      pose_carrying(turn_between(Vec2::UnitX(), touch.tangent) + curve->z[own + 1], Vec2::Zero(),
                    touch.place + curve->z[own] * left_of(touch.tangent));
  set_prior(touch, curve);
  const auto row_of = [](const TrialFoot& foot, const Vec2& normal,
                         double /*lever*/) -> Eigen::Vector4d {
    return arc_motions(foot.t).transpose() * normal;
  };
  if (!add_points(touch, data, arc, Vec2::Zero(), row_of, curve)) {
    return false;
  }
  if (!touch.normal_weights.empty()) {
    add_normals(
        touch, data, Vec2::Zero(), [&](double s) { return arc.derivatives(s); },
        [](int k, double s, const CurveDerivatives& /*foot*/, const NormalAtFoot& there,
           const Vec2& /*lever*/) {
          return there.turn_by(arc_motions(s).col(k), arc_motions_by_s(s).col(k));
        },
        curve);
  }
  return std::isfinite(curve->chi2) && curve->root.allFinite();
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

/// Speed by t at the touched place of a spline.
double speed_at_touch(const TouchedShape& spline) {
  const auto curve = make_curve(CurveClass::CubicSpline, spline.values);
  return curve ? derivatives(*curve, spline.t).first.norm() : 0.0;
}

void set_normal_weights(const CanonicalFit& fit, const FitData& data, Touch* touch) {
  if (residual_count(data) > data.points.size()) {
    for (const FittedPoint& point : fit.points) {
      touch->normal_weights.push_back(point.normal_weight);
    }
  }
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

std::optional<TouchedArc> arc_of(const CanonicalFit& fit, const FitData& data) {
  if (!fit.polynomial) {
    return std::nullopt;
  }
  const double t = fit.points[reference_point(data)].polynomial_t;
  const PolynomialCoefficients& c = *fit.polynomial;
  // A spline's t is the one by which x, across the third derivative, bends to the front.
  const Vec2 third = 6.0 * c.col(3);
  const Vec2 second = second_derivative(c, t);
  const double way = std::copysign(1.0, cross(second, third));
  const Vec2 first = way * first_derivative(c, t);
  const double speed = first.norm();
  if (!(speed > 0.0)) {
    return std::nullopt;
  }
  TouchedArc arc;
  Touch& touch = arc.touch;
  touch.curve_class = fit.shape.curve_class;
  touch.as_arc = true;
  touch.shape = normalised_shape(
      touch.curve_class, {fit.shape.values, fit.points[reference_point(data)].t}, data.scale);
  touch.place = PolynomialCurve2{c}.position(t);
  touch.tangent = first / speed;
  set_normal_weights(fit, data, &touch);
  const Vec2 normal = left_of(touch.tangent);
  const double speed2 = speed * speed;
  const double speed3 = way * speed2 * speed;
  arc.curve.z.head<4>() << second.dot(touch.tangent) / speed2, second.dot(normal) / speed2,
      third.dot(touch.tangent) / speed3, third.dot(normal) / speed3;
  arc.curve.t.reserve(fit.points.size());
  for (const FittedPoint& point : fit.points) {
    arc.curve.t.push_back(way * speed * (point.polynomial_t - t));
  }
  return arc;
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
  const double speed = speed_at_touch(touch.shape);
  for (double& t : curve.t) {
    t = speed * (t - touch.shape.t);
  }
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
  const double speed = speed_at_touch(*shape);
  for (double& t : curve.t) {
    t = shape->t + t / speed;
  }
  return curve;
}

}  // namespace palpate
