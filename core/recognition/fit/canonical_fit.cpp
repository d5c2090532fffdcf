#include "core/recognition/fit/canonical_fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/curves/algebraic/canonical_conic.h"
#include "core/curves/algebraic/canonical_cubic.h"
#include "core/curves/curve.h"
#include "core/recognition/fit/inverse_information.h"
#include "core/recognition/fit/orthogonal/measured_normal.h"

namespace palpate {
namespace {

/// Shape and pose in the fit's frame, in metres, and the canonical parameter
/// t = scale * (fit parameter) + shift (polynomials only).
struct Placement {
  ShapeParameters shape;
  Pose2 frame_T_curve;
  Pose2 world_T_curve = {};
  double t_scale = 1.0;
  double t_shift = 0.0;
};

Vec2 mean_position(const FitData& data) {
  Vec2 sum = Vec2::Zero();
  for (const FitPoint& point : data.points) {
    sum += point.position;
  }
  return sum / static_cast<double>(data.points.size());
}

std::optional<Placement> place_line(const ConicCoefficients& q, const FitData& data) {
  const Vec2 normal(q[3], q[4]);
  const double norm = normal.norm();
  if (!(norm > 0.0)) {
    return std::nullopt;
  }
  // Where the line lies nearest to the points' mean, along the first patch's direction of travel.
  const Vec2 mean = mean_position(data);
  const Vec2 origin = mean - (normal.dot(mean) + q[5]) / (norm * norm) * normal;
  Vec2 direction = -left_of(normal) / norm;
  // Every sample of a patch may have been set aside.
  const auto first = std::find_if(data.patches.begin(), data.patches.end(),
                                  [](const PatchSpan& patch) { return patch.size() > 0; });
  if (first != data.patches.end() && direction.dot(data.points[first->end - 1].position -
                                                   data.points[first->begin].position) < 0.0) {
    direction = -direction;
  }
  return Placement{
      {CurveClass::Line, Eigen::Vector3d::Zero()},
      {data.scale * origin.x(), data.scale * origin.y(), std::atan2(direction.y(), direction.x())}};
}

std::optional<Placement> place_conic(CurveClass curve_class, const ImplicitFit& fit,
                                     const FitData& data) {
  const ConicCoefficients& q = fit.coefficients;
  if (curve_class == CurveClass::Circle) {
    // A radius beyond this many half extents cannot be told from a line in double precision.
    constexpr double kLargestRadius = 1e8;
    if (!(std::abs(q[0]) * kLargestRadius > std::hypot(q[3], q[4]))) {
      return std::nullopt;
    }
  }
  const auto canonical = canonicalise_as(curve_class, q);
  if (!canonical) {
    return std::nullopt;
  }
  Placement placement;
  placement.shape = {curve_class, data.scale * canonical->values};
  placement.frame_T_curve = canonical->world_T_curve;
  Pose2& pose = placement.frame_T_curve;
  if (curve_class == CurveClass::Hyperbola) {
    // The branch x > 0 is the one touched: by the feet, for the centre of a tip whose radius is
    // larger than a may lie beyond the other branch.
    const Vec2 mean_foot = std::accumulate(fit.feet.begin(), fit.feet.end(), Vec2(0.0, 0.0)) /
                           static_cast<double>(fit.feet.size());
    if ((mean_foot - pose.translation()).dot(Vec2(std::cos(pose.theta), std::sin(pose.theta))) <
        0.0) {
      pose.theta += kPi;
    }
  }
  if (curve_class == CurveClass::Circle) {
    pose.theta = -data.frame.theta;  // 0 in the world
  }
  pose.x *= data.scale;
  pose.y *= data.scale;
  return placement;
}

/// Appendix B for each model. `c` in metres.
std::optional<Placement> place_polynomial(CurveClass curve_class, const PolynomialCoefficients& c) {
  const CubicCanonicalisation canonical = canonicalise_as(curve_class, PolynomialCurve2{c});
  if (!canonical.curve) {
    return std::nullopt;
  }
  return Placement{{curve_class, canonical.curve->values},
                   canonical.curve->world_T_curve,
                   {},
                   canonical.curve->canonical_t.scale,
                   canonical.curve->canonical_t.shift};
}

std::optional<Placement> place_of(const ClassFit& fit, const FitData& data) {
  if (fit.at_limit) {
    return std::nullopt;
  }
  if (fit.polynomial) {
    return place_polynomial(fit.curve_class, data.scale * fit.polynomial->coefficients);
  }
  return fit.curve_class == CurveClass::Line ? place_line(fit.implicit->coefficients, data)
                                             : place_conic(fit.curve_class, *fit.implicit, data);
}

/// Placed in the world too.
std::optional<Placement> placed_in_world(const ClassFit& fit, const FitData& data) {
  auto placement = place_of(fit, data);
  if (!placement || !placement->shape.values.allFinite() ||
      !make_curve(placement->shape.curve_class, placement->shape.values)) {
    return std::nullopt;
  }
  Pose2& frame_T_curve = placement->frame_T_curve;
  placement->world_T_curve = data.frame * frame_T_curve;
  // Of two poses that are the same, the one nearer to the world's axes.
  if (pose_symmetry(placement->shape.curve_class) == 2 &&
      std::abs(placement->world_T_curve.theta) > 0.5 * kPi) {
    frame_T_curve.theta += kPi;
    placement->world_T_curve = data.frame * frame_T_curve;
    placement->t_scale = -placement->t_scale;
    placement->t_shift = -placement->t_shift;
  }
  return placement;
}

/// Canonical parameter of a point on an implicit curve.
double parameter_of(const ShapeParameters& shape, const Vec2& local) {
  const double a = shape.values[0];
  const double b = shape.values[1];
  switch (shape.curve_class) {
    case CurveClass::Line:
      return local.x();
    case CurveClass::Circle:
      return std::atan2(local.y(), local.x());
    case CurveClass::Ellipse:
      return std::atan2(local.y() / b, local.x() / a);
    default:
      return std::asinh(local.y() / b);
  }
}

/// Near the foot of a point, all in the curve's frame.
NormalAtFoot curve_at(const Curve& curve, double t, const Vec2& point) {
  const CurveDerivatives at = derivatives(curve, t);
  const double speed = at.first.norm();
  const Vec2 normal = speed > 0.0 ? Vec2(left_of(at.first) / speed) : Vec2(0.0, 0.0);
  return {normal, at.first, at.second, (point - at.position).dot(normal)};
}

/// By what angle the normal at the foot turns, by [x; y; theta; shape]. `step`: of t, for central
/// differences.
Eigen::Matrix<double, 6, 1> turn_by_pose_and_shape(const Curve& curve, double t,
                                                   const NormalAtFoot& at,
                                                   const Eigen::Matrix2d& world_R_curve,
                                                   double step) {
  const Eigen::Matrix<double, 2, 3> by_shape = position_by_parameters(curve, t);
  const Eigen::Matrix<double, 2, 3> by_shape_and_t =
      (position_by_parameters(curve, t + step) - position_by_parameters(curve, t - step)) /
      (2.0 * step);
  Eigen::Matrix<double, 6, 1> turn;
  for (int k = 0; k < 2; ++k) {
    turn[k] = at.turn_by(world_R_curve.transpose().col(k), Vec2::Zero());
  }
  turn[2] = class_of(curve) == CurveClass::Circle
                ? 0.0
                : at.turn_by(left_of(derivatives(curve, t).position), left_of(at.first));
  for (int k = 0; k < 3; ++k) {
    turn[3 + k] = at.turn_by(by_shape.col(k), by_shape_and_t.col(k));
  }
  return turn;
}

/// The measured normals' residuals and information, at the feet found. On its own, so that points
/// without do not pay.
[[gnu::noinline]] void add_normals(const Curve& curve, const Pose2& frame_T_curve,
                                   const FitData& data, CanonicalFit* fit,
                                   Eigen::Matrix<double, 6, 6>* pose_first,
                                   std::vector<ResidualRow>* rows) {
  constexpr double kStep = 1e-5;  // of the extent: right to its square
  const Eigen::Matrix2d curve_R_frame = Eigen::Rotation2Dd(-frame_T_curve.theta).toRotationMatrix();
  const Eigen::Matrix2d world_R_curve =
      Eigen::Rotation2Dd(data.frame.theta + frame_T_curve.theta).toRotationMatrix();
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const FitPoint& point = data.points[i];
    if (!has_normal(point)) {
      continue;
    }
    FittedPoint& fitted = fit->points[i];
    const Vec2 local = curve_R_frame * (data.scale * point.position - frame_T_curve.translation());
    const NormalAtFoot at = curve_at(curve, fitted.t, local);
    if (!at.is_followed()) {
      continue;
    }
    fitted.normal_weight = normal_weight(point, data.scale * at.turn_along());
    fitted.normal_residual =
        fitted.normal_weight * normal_miss(curve_R_frame * point.normal, at.normal);
    const ResidualRow row =
        fitted.normal_weight *
        turn_by_pose_and_shape(curve, fitted.t, at, world_R_curve, kStep * data.scale / at.speed());
    for (int k = 0; k < 6; ++k) {
      pose_first->col(k) += row[k] * row;
    }
    if (rows != nullptr) rows->push_back(row);
  }
}

}  // namespace

double chi2_of(const CanonicalFit& fit) {
  double chi2 = 0.0;
  for (const FittedPoint& point : fit.points) {
    chi2 += point.residual * point.residual + point.normal_residual * point.normal_residual;
  }
  return chi2;
}

std::optional<CanonicalPlace> canonical_place(const ClassFit& fit, const FitData& data) {
  const auto placement = placed_in_world(fit, data);
  return placement ? std::optional<CanonicalPlace>({placement->shape, placement->world_T_curve})
                   : std::nullopt;
}

std::optional<CanonicalFit> to_canonical(const ClassFit& fit, const FitData& data) {
  assert((fit.implicit ? fit.implicit->feet.size() : fit.polynomial->t.size()) ==
         data.points.size());
  const auto placement = placed_in_world(fit, data);
  if (!placement) {
    return std::nullopt;
  }
  CanonicalFit canonical;
  canonical.shape = placement->shape;
  canonical.world_T_curve = placement->world_T_curve;
  const bool is_spline = fit.curve_class == CurveClass::CubicSpline;
  if (is_spline) {
    canonical.polynomial = fit.polynomial->coefficients;
  }
  const Pose2& frame_T_curve = placement->frame_T_curve;
  const auto curve = make_curve(canonical.shape.curve_class, canonical.shape.values);
  const auto letters =
      static_cast<Eigen::Index>(parameter_letters(canonical.shape.curve_class).size());
  const Eigen::Index n = letters + 3;
  // Of [pose; shape], so that a class with fewer letters has its part at the top left: fixed sizes
  // are several times as fast.
  Eigen::Matrix<double, 6, 6> pose_first = Eigen::Matrix<double, 6, 6>::Zero();
  const Eigen::Matrix2d curve_R_frame = Eigen::Rotation2Dd(-frame_T_curve.theta).toRotationMatrix();
  const Eigen::Matrix2d world_R_frame = Eigen::Rotation2Dd(data.frame.theta).toRotationMatrix();
  canonical.points.reserve(data.points.size());
  std::vector<ResidualRow> rows;  // a spline's
  // Far away from its vertex shape and pose may have lost so many digits that they are another
  // curve.
  constexpr double kHeld = 0.1;  // of a deviation, at any foot
  bool is_held = true;
  const int side = fit.implicit ? fit.implicit->side : fit.polynomial->side;
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const FitPoint& point = data.points[i];
    FittedPoint fitted;
    double distance = 0.0;
    Vec2 local;  // the foot point in the curve's frame
    if (fit.implicit) {
      const ConicCoefficients& q = fit.implicit->coefficients;
      const Vec2& foot = fit.implicit->feet[i];
      distance = signed_distance_from(foot, q, point.position);
      fitted.normal = conic_gradient(q, foot).normalized();
      local = curve_R_frame * (data.scale * foot - frame_T_curve.translation());
      fitted.t = parameter_of(canonical.shape, local);
    } else {
      const auto& c = fit.polynomial->coefficients;
      const double t = fit.polynomial->t[i];
      fitted.polynomial_t = t;
      fitted.t = placement->t_scale * t + placement->t_shift;
      const PlacedPoint placed = place_on(*fit.polynomial, t, point);
      distance = placed.signed_distance;
      fitted.normal = placed.normal;
      local = position(*curve, fitted.t);
      if (is_spline) {
        const Vec2 held = frame_T_curve * local - data.scale * position_at(c, t);
        is_held = is_held && held.norm() * point.inverse_sigma <= kHeld * data.scale;
      }
    }
    fitted.residual = (distance - side * point.offset) * point.inverse_sigma;

    const Vec2 local_normal = curve_R_frame * fitted.normal;
    fitted.normal = world_R_frame * fitted.normal;
    ResidualRow row;
    row[0] = fitted.normal.x();
    row[1] = fitted.normal.y();
    row[2] = canonical.shape.curve_class == CurveClass::Circle ? 0.0  // a circle turns into itself
                                                               : local_normal.dot(left_of(local));
    row.tail<3>() = position_by_parameters(*curve, fitted.t).transpose() * local_normal;
    row *= point.inverse_sigma / data.scale;  // 1 / sigma in metres
    for (int k = 0; k < 6; ++k) {
      pose_first.col(k) += row[k] * row;
    }
    if (is_spline) rows.push_back(row);
    canonical.points.push_back(fitted);
  }
  if (residual_count(data) > data.points.size()) {
    add_normals(*curve, frame_T_curve, data, &canonical, &pose_first, is_spline ? &rows : nullptr);
  }
  const auto shape_first = [&](const Eigen::Matrix<double, 6, 6>& of) {
    ShapePoseCovariance result(n, n);
    result.topLeftCorner(letters, letters) = of.block(3, 3, letters, letters);
    result.topRightCorner(letters, 3) = of.block(3, 0, letters, 3);
    result.bottomLeftCorner(3, letters) = of.block(0, 3, 3, letters);
    result.bottomRightCorner<3, 3>() = of.topLeftCorner<3, 3>();
    return result;
  };
  if (!is_held || (is_spline && rows.size() < 6)) {
    canonical.covariance = untold_covariance(n);
    return canonical;
  }
  // Rounding leaves the weakest eigenvalue off by about epsilon: then it is right to a millionth.
  constexpr double kTold = 1e6 * std::numeric_limits<double>::epsilon();
  const InverseInformation inverse = inverse_information(
      shape_first(pose_first), canonical.shape.curve_class, canonical.world_T_curve.theta);
  canonical.covariance = inverse.covariance;
  if (is_spline && inverse.weakest < kTold) {
    canonical.covariance = shape_first(covariance_from_rows(rows));
    if (!canonical.covariance.allFinite()) {
      canonical.covariance = untold_covariance(n);
    }
  }
  return canonical;
}

}  // namespace palpate
