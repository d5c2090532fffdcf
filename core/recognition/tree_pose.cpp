#include "core/recognition/tree_pose.h"

#include <cassert>
#include <cmath>

#include "core/invariants/canonical_models.h"

namespace palpate {
namespace {

Vec2 canonical_position(CurveClass curve_class, const Eigen::Vector3d& p, double t) {
  PlanePoint<double> position{0.0, 0.0};
  switch (curve_class) {
    case CurveClass::Ellipse:
      position = EllipseModel::position(p.data(), t);
      break;
    case CurveClass::Parabola:
      position = ParabolaModel::position(p.data(), t);
      break;
    case CurveClass::Hyperbola:
      position = HyperbolaModel::position(p.data(), t);
      break;
    case CurveClass::CubicalParabola:
      position = CubicalParabolaModel::position(p.data(), t);
      break;
    case CurveClass::SemiCubicalParabola:
      position = SemiCubicalParabolaModel::position(p.data(), t);
      break;
    case CurveClass::CubicSpline:
      position = CubicSplineModel::position(p.data(), t);
      break;
    case CurveClass::Line:
    case CurveClass::Circle:
    case CurveClass::Unclassified:
      assert(false);
      break;
  }
  return {position.x, position.y};
}

}  // namespace

Pose2 pose_of(std::span<const TreePoint> points, const SemiSignatureFit& fit) {
  Pose2 pose{0.0, 0.0, fit.orientation};
  Vec2 sum = Vec2::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    sum += points[i].estimate.position -
           pose.rotate(canonical_position(fit.curve_class, fit.parameters, fit.places[i].t));
  }
  sum /= static_cast<double>(points.size());
  pose.x = sum.x();
  pose.y = sum.y();
  return pose;
}

Pose2 circle_pose(std::span<const TreePoint> points, double radius) {
  Vec2 sum = Vec2::Zero();
  for (const TreePoint& point : points) {
    const double angle = point.estimate.tangent_angle;
    const double side = std::copysign(radius, point.estimate.kappa);
    sum += point.estimate.position + side * left_of(Vec2(std::cos(angle), std::sin(angle)));
  }
  sum /= static_cast<double>(points.size());
  return {sum.x(), sum.y(), 0.0};
}

Pose2 line_pose(std::span<const TreePoint> points) {
  Vec2 position = Vec2::Zero();
  Vec2 doubled = Vec2::Zero();
  for (const TreePoint& point : points) {
    position += point.estimate.position;
    doubled += Vec2(std::cos(2.0 * point.estimate.tangent_angle),
                    std::sin(2.0 * point.estimate.tangent_angle));
  }
  position /= static_cast<double>(points.size());
  return {position.x(), position.y(), 0.5 * std::atan2(doubled.y(), doubled.x())};
}

Eigen::Matrix3d shape_covariance(const SemiSignatureFit& fit) {
  const auto count = static_cast<Eigen::Index>(parameter_letters(fit.curve_class).size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.topLeftCorner(count, count) = fit.covariance.topLeftCorner(count, count);
  return covariance;
}

}  // namespace palpate
