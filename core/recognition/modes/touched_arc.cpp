#include "core/recognition/modes/touched_arc.h"

#include <cmath>

#include "core/recognition/modes/reference_point.h"
#include "core/recognition/modes/touched_points.h"
#include "core/recognition/prior/arc_coordinates.h"

namespace palpate {
namespace {

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

}  // namespace

void to_arc_feet(const Curve& spline, double touched_t, std::vector<double>* feet) {
  const double speed = derivatives(spline, touched_t).first.norm();
  for (double& t : *feet) {
    t = speed * (t - touched_t);
  }
}

std::optional<TouchedArc> arc_of_parabola(const Touch& touch, const TouchedCurve& parabola,
                                          bool with_its_t) {
  constexpr double kLeastThird = 1e-9;  // far below any noise
  const auto curve = make_curve(CurveClass::Parabola, parabola.shape.values);
  if (!curve) {
    return std::nullopt;
  }
  const double way = with_its_t ? 1.0 : -1.0;
  const CurveDerivatives at = derivatives(*curve, parabola.shape.t);
  const double speed = at.first.norm();
  const Vec2 tangent = way / speed * at.first;
  const Vec2 second =
      Vec2(at.second.dot(tangent), at.second.dot(left_of(tangent))) / (speed * speed);
  TouchedArc arc;
  arc.touch = touch;
  arc.touch.curve_class = CurveClass::CubicSpline;
  arc.touch.as_arc = true;
  arc.touch.tangent *= way;
  const int own = shape_coordinates(CurveClass::Parabola);
  arc.curve.z << second, kLeastThird * left_of(second).normalized(), way * parabola.z[own],
      parabola.z[own + 1];
  arc.curve.t.reserve(parabola.t.size());
  for (const double t : parabola.t) {
    arc.curve.t.push_back(way * speed * (t - parabola.shape.t));
  }
  return arc;
}

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

}  // namespace palpate
