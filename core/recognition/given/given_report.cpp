#include "core/recognition/given/given_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/curves/length_powers.h"
#include "core/recognition/given/placed/descent.h"
#include "core/recognition/given/placed/foot_parameter.h"

namespace palpate {
namespace {

using Exact = DoubleDouble;

/// Inverse of the information. A direction that is not determined at all gets a variance as large
/// as the arithmetic allows.
SquareMatrix<Exact> inverse_of(const SquareMatrix<Exact>& information, std::size_t n) {
  constexpr double kNothing = 1e-30;  // a hundred roundings of an Exact
  const auto moves = unit_moves(information, n);
  const auto scaled = in_unit_moves(information, n, moves);
  auto lower = lower_factor(scaled, n, 0.0);
  for (double ridge = kNothing; !lower; ridge *= 10.0) {
    lower = lower_factor(scaled, n, ridge);
  }
  SquareMatrix<Exact> inverse{};
  for (std::size_t j = 0; j < n; ++j) {
    std::array<Exact, kMostUnknowns> unit{};
    unit[j] = Exact(1.0);
    const auto column = solve(*lower, n, unit);
    for (std::size_t i = 0; i < n; ++i) {
      inverse[i][j] = column[i] / Exact(moves[i]) / Exact(moves[j]);
    }
  }
  return inverse;
}

/// Of each shape parameter, in metres.
std::array<double, 3> units_of(CurveClass curve_class, const LocalPoints& local) {
  const Eigen::Vector3d powers = length_powers(curve_class);
  std::array<double, 3> units{};
  for (std::size_t i = 0; i < 3; ++i) {
    units[i] = std::pow(local.unit_m, powers[static_cast<Eigen::Index>(i)]);  // of 2: exact
  }
  return units;
}

}  // namespace

void report_place(const PlacedCurve<Exact>& placed, const LocalPoints& local,
                  ShapeParameters* shape, Pose2* world_T_curve) {
  shape->curve_class = placed.curve_class;
  const std::array<double, 3> units = units_of(placed.curve_class, local);
  for (std::size_t i = 0; i < 3; ++i) {
    shape->values[static_cast<Eigen::Index>(i)] = to_double(Exact(units[i]) * placed.shape[i]);
  }
  const auto in_world = [&](double middle_m, const Exact& v) {
    return to_double(Exact(middle_m) + Exact(local.unit_m) * v);
  };
  world_T_curve->x = in_world(local.middle_m.x(), placed.origin.x);
  world_T_curve->y = in_world(local.middle_m.y(), placed.origin.y);
  world_T_curve->theta = placed.curve_class == CurveClass::Circle
                             ? 0.0
                             : std::atan2(to_double(placed.axis.y), to_double(placed.axis.x));
}

ShapePoseCovariance report_covariance(const PlacedCurve<Exact>& placed,
                                      const Squares<Exact>& squares, const LocalPoints& local,
                                      const GivenReach& reach, GivenFit* fit) {
  const Unknowns unknowns(placed.curve_class);
  const auto n = static_cast<std::size_t>(unknowns.count);
  const Eigen::Vector3d powers = length_powers(placed.curve_class);
  const std::array<double, 3> units = units_of(placed.curve_class, local);
  const Vec2 axis(to_double(placed.axis.x), to_double(placed.axis.y));
  // [shape; x; y; theta] = by * unknowns
  const Eigen::Index rows = unknowns.shape + 3;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6> by(rows,
                                                                    static_cast<Eigen::Index>(n));
  by.setZero();
  for (int i = 0; i < unknowns.shape; ++i) {
    by(i, i) = units[static_cast<std::size_t>(i)];
  }
  if (unknowns.x >= 0) {
    by.block<2, 1>(unknowns.shape, unknowns.x) = local.unit_m * axis;
  }
  by.block<2, 1>(unknowns.shape, unknowns.y) = local.unit_m * left_of(axis);
  if (unknowns.angle >= 0) {
    by(rows - 1, unknowns.angle) = 1.0;
  }
  const SquareMatrix<Exact> inverse = inverse_of(squares.information, n);
  ShapePoseCovariance of_unknowns(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  bool open = false;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      of_unknowns(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          to_double(inverse[i][j]);
    }
    // True if the rounding of the coordinates leaves a shape parameter as uncertain as its own
    // size.
    const double size = i < 3 && powers[static_cast<Eigen::Index>(i)] == 0.0
                            ? 1.0
                            : std::abs(to_double(placed.shape[i % 3]));
    const double weight = to_double(local.exact.front().weight);
    open = open || (i < static_cast<std::size_t>(unknowns.shape) &&
                    weight * local.rounding * std::sqrt(to_double(inverse[i][i])) > size);
  }
  widen(reach, &of_unknowns);
  fit->covariance = by * of_unknowns * by.transpose();
  if (open) {
    fit->status = GivenStatus::NotDetermined;
  }
  return of_unknowns;
}

void report_residuals(PlacedCurve<Exact>* placed, const LocalPoints& local,
                      std::span<const GivenPoint> points, GivenFit* fit) {
  const auto curve = curve_of(*placed);
  const double unit_of_t = std::pow(local.unit_m, length_power_of_t(placed->curve_class));  // of 2
  fit->residuals.resize(points.size());
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  Exact squares(0.0);
  std::size_t used = 0;
  const Vec2 axis(to_double(placed->axis.x), to_double(placed->axis.y));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Exact inverse_unit(1.0 / local.unit_m);
    const PlaneVector<Exact> p = placed->to_curve(
        {inverse_unit * (Exact(points[i].position_m.x()) - Exact(local.middle_m.x())),
         inverse_unit * (Exact(points[i].position_m.y()) - Exact(local.middle_m.y()))});
    PlaneVector<Exact> foot;
    if (points[i].set_aside) {
      const Vec2 rough(to_double(p.x), to_double(p.y));
      foot = as<Exact>(parameter_at(placed->curve_class, foot_point(*curve, rough).t));
    } else {
      foot = placed->feet[used];
    }
    const Placement<Exact> there = place(*placed, p, &foot);
    const Exact distance =
        Exact(local.unit_m) * there.distance - Exact(fit->side * points[i].tip_radius_m);
    GivenResidual& residual = fit->residuals[i];
    residual.t = unit_of_t * t_at(placed->curve_class, as_double(foot));
    if (placed->curve_class == CurveClass::Circle) {
      // Its pose is told without a turn.
      residual.t = wrap_angle(residual.t + std::atan2(axis.y(), axis.x()));
    }
    residual.distance_m = to_double(distance);
    const Vec2 at(to_double(there.foot.position.x), to_double(there.foot.position.y));
    const Vec2 local_foot = axis * at.x() + left_of(axis) * at.y() +
                            Vec2(to_double(placed->origin.x), to_double(placed->origin.y));
    residual.foot_m = local.middle_m + local.unit_m * local_foot;
    if (has_normal(points[i]) && to_double(there.speed) > 0.0) {
      const Vec2 normal = points[i].normal.normalized();
      const Exact miss = normal_miss(*placed, there, {Exact(normal.x()), Exact(normal.y())});
      residual.normal_rad = 2.0 * std::atan(0.5 * to_double(miss));
    }
    if (!points[i].set_aside) {
      ++used;
      squares = squares + distance * distance;
      lowest = std::min(lowest, residual.distance_m);
      highest = std::max(highest, residual.distance_m);
    }
  }
  fit->rms_m = std::sqrt(to_double(squares) / static_cast<double>(used));
  fit->peak_to_valley_m = highest - lowest;
}

void report_noise(std::span<const GivenPoint> points, const LocalPoints& local, bool stated,
                  double default_sigma_m, double squares, GivenFit* fit) {
  fit->sigma_stated = stated;
  fit->normals = local.normals;
  fit->dof = static_cast<int>(local.index.size() + local.normals) -
             degrees_of_freedom(fit->shape.curve_class);
  if (stated) {
    fit->chi2 = squares;
    double sum = 0.0;
    for (const std::size_t i : local.index) {
      const double own_m = noise_of(points[i], default_sigma_m);
      sum += own_m * own_m;
    }
    fit->sigma_m = std::sqrt(sum / static_cast<double>(local.index.size()));
    return;
  }
  if (fit->dof <= 0) {
    fit->covariance.diagonal().setConstant(std::numeric_limits<double>::infinity());
    return;
  }
  // Here `squares` is in squared local units.
  const double variance = squares / static_cast<double>(fit->dof);
  fit->chi2 = static_cast<double>(fit->dof);
  fit->sigma_m = local.unit_m * std::sqrt(variance);
  fit->covariance *= variance;
}

void settle_pose(std::span<const GivenPoint> points, const LocalPoints& local, GivenFit* fit) {
  Pose2& pose = fit->world_T_curve;
  if (fit->shape.curve_class == CurveClass::Line) {
    const Vec2 first = points[local.index.front()].position_m;
    const Vec2 last = points[local.index.back()].position_m;
    if (pose.rotate_back(last - first).x() < 0.0) {
      pose.theta = wrap_angle(pose.theta + kPi);
      for (GivenResidual& residual : fit->residuals) {
        residual.t = -residual.t;
        residual.distance_m = -residual.distance_m;
      }
      fit->side = -fit->side;
    }
  } else if (pose_symmetry(fit->shape.curve_class) == 2 && std::abs(pose.theta) > 0.5 * kPi) {
    pose.theta = wrap_angle(pose.theta + kPi);
    const bool closed = fit->shape.curve_class == CurveClass::Ellipse;
    for (GivenResidual& residual : fit->residuals) {
      // Half a turn maps a cubical parabola's t to -t: the direction of increasing t reverses.
      residual.t = closed ? wrap_angle(residual.t + kPi) : -residual.t;
      residual.distance_m = closed ? residual.distance_m : -residual.distance_m;
    }
    fit->side = closed ? fit->side : -fit->side;
  }
}

}  // namespace palpate
