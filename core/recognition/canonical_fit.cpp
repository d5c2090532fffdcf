#include "core/recognition/canonical_fit.h"

#include <Eigen/Eigenvalues>
#include <cassert>
#include <cmath>

#include "core/curves/curve.h"

namespace palpate {
namespace {

/// Shape and pose in the fit's frame, in metres, and the canonical parameter
/// t = scale * (fit parameter) + shift (polynomials only).
struct Placement {
  ShapeParameters shape;
  Pose2 frame_T_curve;
  double t_scale = 1.0;
  double t_shift = 0.0;
};

Vec2 conic_gradient(const ConicCoefficients& q, const Vec2& p) {
  return {2.0 * q[0] * p.x() + q[1] * p.y() + q[3], q[1] * p.x() + 2.0 * q[2] * p.y() + q[4]};
}

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
  const auto first = data.patch(0);
  Vec2 direction = -left_of(normal) / norm;
  if (direction.dot(first.back().position - first.front().position) < 0.0) {
    direction = -direction;
  }
  return Placement{{CurveClass::Line, Eigen::Vector3d::Zero()},
                   {data.scale * origin.x(), data.scale * origin.y(), std::atan2(direction.y(), direction.x())}};
}

std::optional<Placement> place_circle(const ConicCoefficients& q, const FitData& data) {
  // A radius beyond this many half extents cannot be told from a line in double precision.
  constexpr double kLargestRadius = 1e8;
  const double norm = std::hypot(q[3], q[4]);
  if (!(std::abs(q[0]) * kLargestRadius > norm)) {
    return std::nullopt;
  }
  const Vec2 centre(-q[3] / (2.0 * q[0]), -q[4] / (2.0 * q[0]));
  const double radius2 = centre.squaredNorm() - q[5] / q[0];
  if (!(radius2 > 0.0)) {
    return std::nullopt;
  }
  return Placement{
      {CurveClass::Circle, Eigen::Vector3d(data.scale * std::sqrt(radius2), 0.0, 0.0)},
      {data.scale * centre.x(), data.scale * centre.y(), -data.frame.theta}};  // world angle 0
}

std::optional<Placement> place_conic(CurveClass curve_class, const ConicCoefficients& q,
                                     const FitData& data) {
  const double d = 4.0 * q[0] * q[2] - q[1] * q[1];
  const Vec2 centre((q[1] * q[4] - 2.0 * q[2] * q[3]) / d, (q[1] * q[3] - 2.0 * q[0] * q[4]) / d);
  const double at_centre = 0.5 * (q[3] * centre.x() + q[4] * centre.y()) + q[5];
  // Eigenvalues of the quadratic part without cancellation: the smaller one from the determinant.
  const double half_trace = 0.5 * (q[0] + q[2]);
  const double radius = std::hypot(0.5 * (q[0] - q[2]), 0.5 * q[1]);
  const double large = half_trace + std::copysign(radius, half_trace);
  const double small = 0.25 * d / large;
  const double large_angle = 0.5 * std::atan2(q[1], q[0] - q[2]) +
                             (half_trace >= 0.0 ? 0.0 : 0.5 * kPi);
  // Along the axis of eigenvalue l the squared semi-axis is -at_centre / l.
  const double square_large = -at_centre / large;
  const double square_small = -at_centre / small;
  Placement placement;
  placement.shape.curve_class = curve_class;
  double angle = 0.0;
  double a2 = 0.0;
  double b2 = 0.0;
  if (curve_class == CurveClass::Ellipse) {
    angle = large_angle + 0.5 * kPi;  // the long axis belongs to the small eigenvalue
    a2 = square_small;
    b2 = square_large;
  } else {
    const bool real_is_large = square_large > 0.0;
    angle = real_is_large ? large_angle : large_angle + 0.5 * kPi;
    a2 = real_is_large ? square_large : square_small;
    b2 = real_is_large ? -square_small : -square_large;
    const Vec2 axis(std::cos(angle), std::sin(angle));
    if ((mean_position(data) - centre).dot(axis) < 0.0) {
      angle += kPi;  // the branch x > 0 is the one touched
    }
  }
  if (!(a2 > 0.0 && b2 > 0.0) || !std::isfinite(a2) || !std::isfinite(b2)) {
    return std::nullopt;
  }
  placement.shape.values = data.scale * Eigen::Vector3d(std::sqrt(a2), std::sqrt(b2), 0.0);
  placement.frame_T_curve = {data.scale * centre.x(), data.scale * centre.y(), angle};
  return placement;
}

/// Appendix B for each model, chirality kept. `c` in metres.
std::optional<Placement> place_polynomial(CurveClass curve_class,
                                          const PolynomialCoefficients& c) {
  Placement placement;
  placement.shape.curve_class = curve_class;
  const auto place = [&](const Vec2& origin, const Vec2& x_axis) {
    placement.frame_T_curve = {origin.x(), origin.y(), std::atan2(x_axis.y(), x_axis.x())};
  };
  if (curve_class == CurveClass::Parabola) {
    const double opening = c.col(2).norm();
    const Vec2 x_axis = c.col(2) / opening;
    const double vertex = -x_axis.dot(c.col(1)) / (2.0 * opening);
    const double across = cross(x_axis, c.col(1));
    if (!(opening > 0.0) || across == 0.0) {
      return std::nullopt;
    }
    placement.shape.values = {across * across / (4.0 * opening), 0.0, 0.0};
    place(c.col(0) + vertex * (c.col(1) + vertex * c.col(2)), x_axis);
    placement.t_scale = 2.0 * opening / across;
    placement.t_shift = -vertex * placement.t_scale;
    return placement;
  }
  const double cubic = c.col(3).norm();
  if (!(cubic > 0.0)) {
    return std::nullopt;
  }
  Vec2 x_axis = -left_of(c.col(3)) / cubic;
  if (curve_class == CurveClass::CubicalParabola) {
    const double along = x_axis.dot(c.col(1));
    if (along == 0.0) {
      return std::nullopt;
    }
    placement.shape.values = {cubic / (along * along * along), cross(x_axis, c.col(1)) / along,
                              0.0};
    place(c.col(0), x_axis);
    placement.t_scale = along;
    return placement;
  }
  double quadratic = x_axis.dot(c.col(2));
  if (quadratic == 0.0) {
    return std::nullopt;
  }
  if (quadratic < 0.0) {  // c2 < 0: turn by pi
    x_axis = -x_axis;
    quadratic = -quadratic;
  }
  const double vertex = -x_axis.dot(c.col(1)) / (2.0 * quadratic);
  const Vec2 first = c.col(1) + vertex * (2.0 * c.col(2) + 3.0 * vertex * c.col(3));
  const Vec2 second = c.col(2) + 3.0 * vertex * c.col(3);
  const double third = cross(x_axis, c.col(3));
  const double root = std::copysign(std::sqrt(quadratic), third);  // makes a positive
  const double a = std::abs(third) / (quadratic * std::sqrt(quadratic));
  const double b = cross(x_axis, second) / quadratic;
  placement.shape.values = {a, b,
                            curve_class == CurveClass::CubicSpline ? cross(x_axis, first) / root
                                                                   : 0.0};
  place(c.col(0) + vertex * (c.col(1) + vertex * (c.col(2) + vertex * c.col(3))), x_axis);
  placement.t_scale = root;
  placement.t_shift = -vertex * root;
  return placement;
}

std::optional<Placement> place_of(const ClassFit& fit, const FitData& data) {
  if (fit.at_limit) {
    return std::nullopt;
  }
  if (fit.polynomial) {
    return place_polynomial(fit.curve_class, data.scale * fit.polynomial->coefficients);
  }
  const ConicCoefficients& q = fit.implicit->coefficients;
  switch (fit.curve_class) {
    case CurveClass::Line:
      return place_line(q, data);
    case CurveClass::Circle:
      return place_circle(q, data);
    default:
      return place_conic(fit.curve_class, q, data);
  }
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

/// Inverse of an information matrix of known rank; null directions get variance 0.
ShapePoseCovariance invert(const ShapePoseCovariance& information, int rank) {
  const Eigen::Index n = information.rows();
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1> scale(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    scale[i] = information(i, i) > 0.0 ? 1.0 / std::sqrt(information(i, i)) : 0.0;
  }
  const ShapePoseCovariance scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<ShapePoseCovariance> solver(scaled);
  ShapePoseCovariance inverse = ShapePoseCovariance::Zero(n, n);
  for (Eigen::Index k = n - rank; k < n; ++k) {
    // Rounding leaves the weakest direction no smaller than this; beyond it the variance is as good
    // as infinite, and says so by its size.
    const double least = std::numeric_limits<double>::epsilon();
    const double value = std::max(solver.eigenvalues()[k], least);
    inverse += solver.eigenvectors().col(k) * solver.eigenvectors().col(k).transpose() / value;
  }
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

}  // namespace

std::optional<CanonicalFit> to_canonical(const ClassFit& fit, const FitData& data) {
  assert(fit.on_all);
  auto placement = place_of(fit, data);
  if (!placement || !placement->shape.values.allFinite()) {
    return std::nullopt;
  }
  CanonicalFit canonical;
  canonical.shape = placement->shape;
  Pose2& frame_T_curve = placement->frame_T_curve;
  canonical.world_T_curve = data.frame * frame_T_curve;
  // Of two poses that are the same, the one nearer to the world's axes.
  if (pose_symmetry(canonical.shape.curve_class) == 2 &&
      std::abs(canonical.world_T_curve.theta) > 0.5 * kPi) {
    frame_T_curve.theta += kPi;
    canonical.world_T_curve = data.frame * frame_T_curve;
    placement->t_scale = -placement->t_scale;
    placement->t_shift = -placement->t_shift;
  }
  const auto curve = make_curve(canonical.shape.curve_class, canonical.shape.values);
  if (!curve) {
    return std::nullopt;
  }
  const auto letters =
      static_cast<Eigen::Index>(parameter_letters(canonical.shape.curve_class).size());
  const Eigen::Index n = letters + 3;
  ShapePoseCovariance information = ShapePoseCovariance::Zero(n, n);
  canonical.points.reserve(data.points.size());
  const int side = fit.implicit ? fit.implicit->side : fit.polynomial->side;
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const FitPoint& point = data.points[i];
    FittedPoint fitted;
    double distance = 0.0;
    if (fit.implicit) {
      const ConicCoefficients& q = fit.implicit->coefficients;
      Vec2 foot;
      distance = signed_distance(q, point.position, &foot);
      fitted.normal = conic_gradient(q, foot).normalized();
      fitted.t = parameter_of(canonical.shape, frame_T_curve.to_local(data.scale * foot));
    } else {
      const double t = fit.polynomial->t[i];
      fitted.t = placement->t_scale * t + placement->t_shift;
      const PlacedPoint placed = place_on(*fit.polynomial, t, point.position);
      distance = placed.signed_distance;
      fitted.normal = placed.normal;
    }
    fitted.residual = (distance - side * point.offset) * point.inverse_sigma;

    const Vec2 local_normal = frame_T_curve.rotate_back(fitted.normal);
    fitted.normal = data.frame.rotate(fitted.normal);
    const Vec2 local = position(*curve, fitted.t);
    Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, 6> row(n);
    row.head(letters) =
        (local_normal.transpose() * position_by_parameters(*curve, fitted.t)).head(letters);
    row[letters] = fitted.normal.x();
    row[letters + 1] = fitted.normal.y();
    row[letters + 2] = canonical.shape.curve_class == CurveClass::Circle
                           ? 0.0  // a circle turns into itself
                           : local_normal.dot(left_of(local));
    const double weight = point.inverse_sigma / data.scale;  // 1 / sigma in metres
    information.noalias() += weight * weight * row.transpose() * row;
    canonical.points.push_back(fitted);
  }
  canonical.covariance = invert(information, degrees_of_freedom(canonical.shape.curve_class));
  return canonical;
}

}  // namespace palpate
