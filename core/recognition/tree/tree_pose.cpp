#include "core/recognition/tree/tree_pose.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/curves/curve.h"
#include "core/invariants/signature_fit/canonical_models.h"
#include "core/numerics/probability/negligible.h"

namespace palpate {
namespace {

Vec2 canonical_position(CurveClass curve_class, const Eigen::Vector3d& p, double t) {
  PlanePoint<double> position{0.0, 0.0};
  with_model(curve_class, [&](auto model) { position = model.position(p.data(), t); });
  return {position.x, position.y};
}

/// Weighted mean curvature of a patch over its standard deviation. A patch turns to one side; a
/// single curvature may be noise.
double turn_of_patch(std::span<const TreePoint> points, int patch) {
  double sum = 0.0;
  double weights = 0.0;
  for (const TreePoint& point : points) {
    if (point.patch == patch) {
      const double kappa = point.estimate.kappa;
      // Exact estimates are known to rounding.
      const double weight = 1.0 / std::max(point.estimate.covariance(2, 2),
                                           std::numeric_limits<double>::epsilon() * kappa * kappa +
                                               std::numeric_limits<double>::min());
      sum += weight * kappa;
      weights += weight;
    }
  }
  return sum / std::sqrt(weights);
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

std::optional<Pose2> pose_by_places(const ShapeParameters& shape, std::span<const TreePoint> points,
                                    double frame) {
  const auto curve = make_curve(shape.curve_class, shape.values);
  if (!curve) {
    return std::nullopt;
  }
  struct Place {
    Vec2 touched;
    Vec2 on_curve;
  };
  std::vector<Place> places;
  double first_theta = 0.0;
  double turns = 0.0;  // relative to the first point's orientation
  // A curve with two-fold symmetry has every place twice.
  const double symmetry = pose_symmetry(shape.curve_class) == 2 ? kPi : 2.0 * kPi;
  for (const TreePoint& point : points) {
    const LocalEstimate& estimate = point.estimate;
    const auto place = localise(
        *curve, {wrap_angle(estimate.tangent_angle - frame), estimate.kappa, estimate.kappa_s});
    if (!place) {
      continue;
    }
    const double theta =
        pose_from_contact(*curve, *place, estimate.position, estimate.tangent_angle).theta;
    if (places.empty()) {
      first_theta = theta;
    }
    const double turn = std::remainder(theta - first_theta, symmetry);
    const bool other_half = std::cos(theta - first_theta - turn) < 0.0;
    const Vec2 on_curve = position(*curve, place->t);
    places.push_back({estimate.position, other_half ? Vec2(-on_curve) : on_curve});
    turns += turn;
  }
  if (places.empty()) {
    return std::nullopt;
  }
  const auto count = static_cast<double>(places.size());
  Pose2 pose{0.0, 0.0, wrap_angle(first_theta + turns / count)};
  for (const Place& place : places) {
    const Vec2 shift = (place.touched - pose.rotate(place.on_curve)) / count;
    pose.x += shift.x();
    pose.y += shift.y();
  }
  return pose;
}

TangentCircle tangent_circle(std::span<const TreePoint> points, double radius,
                             double relative_floor) {
  // Unknowns: the centre, relative to the points' mean, and the radius, both in units of `radius`.
  // A point's offset error lies along its normal; an error of its angle moves the centre along its
  // tangent.
  Vec2 mean = Vec2::Zero();
  for (const TreePoint& point : points) {
    mean += point.estimate.position;
  }
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double sum = 0.0;
  // The side on which a patch's centre lies is used only if its curvature is significant. The most
  // significant patch is always used.
  std::vector<double> turns;
  double side_limit = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool same_patch = i > 0 && points[i].patch == points[i - 1].patch;
    turns.push_back(same_patch ? turns.back() : turn_of_patch(points, points[i].patch));
    side_limit = std::max(side_limit, std::abs(turns.back()));
  }
  side_limit = std::min(side_limit, kNegligibleDeviations);
  const auto add = [&](const Eigen::Vector3d& row, double value, double variance) {
    const double weight = 1.0 / (variance + relative_floor * relative_floor);
    normal_matrix += weight * row * row.transpose();
    right += weight * value * row;
    sum += weight * value * value;
  };
  int unsided = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const LocalEstimate& estimate = points[i].estimate;
    const double turn = turns[i];
    const Vec2 tangent(std::cos(estimate.tangent_angle), std::sin(estimate.tangent_angle));
    const Vec2 inward = std::copysign(1.0, turn) * left_of(tangent);
    const Vec2 p = (estimate.position - mean) / radius;
    if (std::abs(turn) >= side_limit) {
      add({inward.x(), inward.y(), -1.0}, inward.dot(p),
          estimate.covariance(0, 0) / (radius * radius));
    } else {
      ++unsided;
    }
    add({tangent.x(), tangent.y(), 0.0}, tangent.dot(p), estimate.covariance(1, 1));
  }
  const Eigen::Vector3d solution = normal_matrix.ldlt().solve(right);
  TangentCircle circle;
  const Vec2 centre = mean + radius * solution.head<2>();
  circle.pose = {centre.x(), centre.y(), 0.0};
  circle.chi2 = std::max(0.0, sum - right.dot(solution));
  circle.dof = 2 * static_cast<int>(points.size()) - 3 - unsided;
  return circle;
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
