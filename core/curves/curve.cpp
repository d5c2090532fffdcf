#include "core/curves/curve.h"

#include <cmath>

#include "core/curves/all_feet.h"
#include "core/curves/foot_point.h"

namespace palpate {
namespace {

/// As foot_at_distance().
template <typename C>
FootPoint at_distance(const C& curve, const Vec2& point, double distance, double tolerance) {
  FootPoint best = curve.foot_point(point);
  if constexpr (requires { all_feet(curve, point); }) {
    if (!(std::abs(best.distance) < distance - tolerance)) {
      return best;
    }
    const auto off = [&](const FootPoint& foot) {
      return std::abs(std::abs(foot.distance) - distance);
    };
    const FootPlaces feet = all_feet(curve, point);
    for (std::size_t k = 0; k < feet.count; ++k) {
      // (a cusp is among them whether or not the arms lead away from the point)
      const FootPoint foot = foot_point_at(curve, feet.t[k], point);
      if (is_nearest_beside(curve, feet.t[k], point) && off(foot) < off(best)) {
        best = foot;
      }
    }
  }
  return best;
}

template <typename C>
std::optional<Curve> make(const Eigen::Vector3d& values) {
  const C curve = C::from_parameters(values.head<C::parameter_count>());
  if (!curve.is_valid()) {
    return std::nullopt;
  }
  return curve;
}

}  // namespace

std::optional<Curve> make_curve(CurveClass curve_class, const Eigen::Vector3d& values) {
  switch (curve_class) {
    case CurveClass::Unclassified:
      return std::nullopt;
    case CurveClass::Line:
      return make<Line>(values);
    case CurveClass::Circle:
      return make<Circle>(values);
    case CurveClass::Ellipse:
      return make<Ellipse>(values);
    case CurveClass::Parabola:
      return make<Parabola>(values);
    case CurveClass::Hyperbola:
      return make<Hyperbola>(values);
    case CurveClass::CubicalParabola:
      return make<CubicalParabola>(values);
    case CurveClass::SemiCubicalParabola:
      return make<SemiCubicalParabola>(values);
    case CurveClass::CubicSpline:
      return make<CubicSpline>(values);
  }
  return std::nullopt;
}

CurveClass class_of(const Curve& curve) {
  return std::visit([](const auto& c) { return c.curve_class; }, curve);
}

Eigen::Vector3d parameters(const Curve& curve) {
  return std::visit(
      [](const auto& c) {
        Eigen::Vector3d values = Eigen::Vector3d::Zero();
        values.head<std::decay_t<decltype(c)>::parameter_count>() = c.parameters();
        return values;
      },
      curve);
}

Vec2 position(const Curve& curve, double t) {
  return std::visit([t](const auto& c) { return c.position(t); }, curve);
}

CurveDerivatives derivatives(const Curve& curve, double t) {
  return std::visit([t](const auto& c) { return c.derivatives(t); }, curve);
}

LocalGeometry geometry(const Curve& curve, double t) {
  return std::visit([t](const auto& c) { return c.geometry(t); }, curve);
}

Eigen::Matrix<double, 2, 3> position_by_parameters(const Curve& curve, double t) {
  return std::visit(
      [t](const auto& c) {
        Eigen::Matrix<double, 2, 3> m = Eigen::Matrix<double, 2, 3>::Zero();
        m.leftCols<std::decay_t<decltype(c)>::parameter_count>() = c.position_by_parameters(t);
        return m;
      },
      curve);
}

FootPoint foot_point(const Curve& curve, const Vec2& point) {
  return std::visit([&point](const auto& c) { return c.foot_point(point); }, curve);
}

FootPoint foot_at_distance(const Curve& curve, const Vec2& point, double distance,
                           double tolerance) {
  return std::visit([&](const auto& c) { return at_distance(c, point, distance, tolerance); },
                    curve);
}

FootPoint foot_point_near(const Curve& curve, const Vec2& point, double t_start) {
  return std::visit([&point, t_start](const auto& c) { return foot_point_near(c, point, t_start); },
                    curve);
}

double arc_length(const Curve& curve, double t0, double t1) {
  return std::visit([=](const auto& c) { return c.arc_length(t0, t1); }, curve);
}

double parameter_at_arc_length(const Curve& curve, double t0, double s) {
  return std::visit([=](const auto& c) { return c.parameter_at_arc_length(t0, s); }, curve);
}

ParameterDomain domain(const Curve& curve) {
  return std::visit([](const auto& c) { return c.domain(); }, curve);
}

std::optional<Localisation> localise(const Curve& curve, const LocalGeometry& local) {
  return std::visit([&local](const auto& c) { return c.localise(local); }, curve);
}

Pose2 pose_from_contact(const Curve& curve, const Localisation& place, const Vec2& world_point,
                        double world_tangent_angle) {
  const double travel = place.along_increasing_t ? 0.0 : kPi;
  const double theta =
      wrap_angle(world_tangent_angle - geometry(curve, place.t).tangent_angle - travel);
  return pose_carrying(theta, position(curve, place.t), world_point);
}

}  // namespace palpate
