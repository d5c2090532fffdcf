#include "core/recognition/modes/moments.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/curves/curve.h"
#include "core/numerics/matrices/small_cholesky.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/fit/inverse_information.h"
#include "core/recognition/modes/mode_search.h"

namespace palpate {
namespace {

using ShapePose = Eigen::Matrix<double, kMostCoordinates, 1>;

/// [shape; x; y; theta] in the normalised frame of a curve at coordinates z.
std::optional<ShapePose> shape_pose_at(const Touch& touch, const TouchedVector& z) {
  const auto shape = shape_at(touch.chart(), z, touch.shape);
  const auto curve = shape ? make_curve(touch.curve_class, shape->values) : std::nullopt;
  if (!curve) {
    return std::nullopt;
  }
  const Pose2 pose = pose_of(touch, z, *curve, shape->t);
  const auto letters = static_cast<Eigen::Index>(parameter_letters(touch.curve_class).size());
  ShapePose x = ShapePose::Zero();
  x.head(letters) = shape->values.head(letters);
  x.segment<3>(letters) << pose.x, pose.y, pose.theta;
  return x;
}

/// b - a, angles the short way round; poses that are half a turn apart may be the same.
ShapePose difference(CurveClass curve_class, const ShapePose& b, const ShapePose& a) {
  const auto theta = static_cast<Eigen::Index>(parameter_letters(curve_class).size()) + 2;
  ShapePose d = b - a;
  d[theta] = std::remainder(d[theta], pose_symmetry(curve_class) == 2 ? kPi : 2.0 * kPi);
  return d;
}

/// The derivatives of [shape; x; y; theta], normalised frame, by the coordinates in units of their
/// widths; coordinate `fixed` (or -1) does not move.
Eigen::Matrix<double, 6, 6> jacobian_at(const Touch& touch, const TouchedCurve& curve, int fixed) {
  constexpr double kStep = 1e-5;  // nearly the cube root of the rounding: central differences
  Eigen::Matrix<double, 6, 6> jacobian = Eigen::Matrix<double, 6, 6>::Zero();
  const int coordinates = shape_coordinates(touch.curve_class) + 2;
  for (int k = 0; k < coordinates; ++k) {
    if (k == fixed) {
      continue;
    }
    TouchedVector ahead = curve.z;
    TouchedVector behind = curve.z;
    ahead[k] += kStep;
    behind[k] -= kStep;
    const auto f = shape_pose_at(touch, ahead);
    const auto g = shape_pose_at(touch, behind);
    if (f && g) {
      jacobian.col(k) = curve.widths[k] / (2.0 * kStep) * difference(touch.curve_class, *f, *g);
    } else if (const auto here = shape_pose_at(touch, curve.z); here && (f || g)) {
      // One-sided at the class's end.
      const ShapePose step =
          f ? difference(touch.curve_class, *f, *here) : difference(touch.curve_class, *here, *g);
      jacobian.col(k) = curve.widths[k] / kStep * step;
    }
  }
  return jacobian;
}

/// To metres, and positions to the world.
Eigen::Matrix<double, 6, 6> world_by_normalised(CurveClass curve_class, const FitData& data) {
  const auto letters = static_cast<Eigen::Index>(parameter_letters(curve_class).size());
  Eigen::Matrix<double, 6, 6> to_world = Eigen::Matrix<double, 6, 6>::Identity();
  for (Eigen::Index k = 0; k < letters; ++k) {
    to_world(k, k) = parameter_scale(curve_class, static_cast<int>(k), data.scale);
  }
  const double c = data.scale * std::cos(data.frame.theta);
  const double s = data.scale * std::sin(data.frame.theta);
  to_world.block<2, 2>(letters, letters) << c, -s, s, c;
  return to_world;
}

/// The share of each slice by the likelihood alone: the signed root of chi-square over its least is
/// a standard normal variable, exactly where the model is linear in some function of the
/// coordinate, and to third order elsewhere. Neither the prior nor the coordinate's scale enters.
std::vector<double> likelihood_shares(const std::vector<PosteriorNode>& nodes) {
  const std::size_t n = nodes.size();
  std::size_t least = 0;
  for (std::size_t i = 1; i < n; ++i) {
    least = nodes[i].curve.chi2 < nodes[least].curve.chi2 ? i : least;
  }
  std::vector<double> root(n, 0.0);
  const auto rise = [&](std::size_t i) {
    return std::sqrt(std::max(nodes[i].curve.chi2 - nodes[least].curve.chi2, 0.0));
  };
  // What lies behind a barrier is no nearer than the barrier.
  for (std::size_t i = least; i + 1 < n; ++i) {
    root[i + 1] = std::max(root[i], rise(i + 1));
  }
  for (std::size_t i = least; i > 0; --i) {
    root[i - 1] = std::min(root[i], -rise(i - 1));
  }
  std::vector<double> shares(n);
  double below = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double up_to =
        i + 1 < n ? 0.5 * std::erfc(-0.5 * (root[i] + root[i + 1]) / std::sqrt(2.0)) : 1.0;
    shares[i] = up_to - below;
    below = up_to;
  }
  return shares;
}

}  // namespace

ShapePoseCovariance second_moment(const CanonicalFit& estimate, const ClassEvidence& evidence,
                                  const FitData& data) {
  const Touch& touch = evidence.touch;
  const CurveClass curve_class = touch.curve_class;
  const auto letters = static_cast<Eigen::Index>(parameter_letters(curve_class).size());
  const Eigen::Index n = letters + 3;
  // The estimate in the normalised frame.
  const Pose2 pose = data.frame.inverse() * estimate.world_T_curve;
  const TouchedShape shape =
      normalised_shape(curve_class, {estimate.shape.values, 0.0}, data.scale);
  ShapePose centre = ShapePose::Zero();
  centre.head(letters) = shape.values.head(letters);
  centre.segment<3>(letters) << pose.x / data.scale, pose.y / data.scale, pose.theta;

  Eigen::Matrix<double, 6, 6> moment = Eigen::Matrix<double, 6, 6>::Zero();
  const std::vector<double> shares = likelihood_shares(evidence.nodes);
  double untold = 0.0;  // of slices so far along the valley that shape and pose do not hold them
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const TouchedCurve& curve = evidence.nodes[i].curve;
    const auto x = shape_pose_at(touch, curve.z);
    if (!x) {
      untold += shares[i];
      continue;
    }
    const TouchedMatrix root = root_of(curve, evidence.widest);
    const Eigen::Matrix<double, 6, 6> jacobian = jacobian_at(touch, curve, evidence.widest);
    const ShapePose away = difference(curve_class, *x, centre);
    const Eigen::Matrix<double, 6, 6> half = inverse_lower(root) * jacobian.transpose();
    moment += shares[i] * (half.transpose() * half + away * away.transpose());
  }
  const Eigen::Matrix<double, 6, 6> to_world = world_by_normalised(curve_class, data);
  moment = to_world * moment * to_world.transpose();
  if (curve_class == CurveClass::Circle) {  // turned into itself: theta is 0 by convention
    moment.row(letters + 2).setZero();
    moment.col(letters + 2).setZero();
  }
  // The valley runs on to where a double ends: it tells nothing.
  return moment.allFinite() && untold <= kNegligibleProbability
             ? ShapePoseCovariance(moment.topLeftCorner(n, n))
             : untold_covariance(n);
}

Eigen::Matrix<double, 6, 6> shape_pose_by_coordinates(const ClassEvidence& evidence,
                                                      const FitData& data) {
  const Touch& touch = evidence.touch;
  return world_by_normalised(touch.curve_class, data) *
         jacobian_at(touch, evidence.nodes[evidence.mode].curve, -1);
}

std::optional<ShapePoseCovariance> bend_added(const ShapePoseCovariance& covariance,
                                              const ShapePoseCovariance& linear,
                                              const ShapePoseCovariance& moment) {
  const ShapePoseCovariance left = covariance + moment - linear;
  // Where most of it cancels, what is left shows that the two halves were rounded differently.
  const ShapePoseCovariance sum = 0.5 * (left + left.transpose());
  // In units of the moment's deviations; a free component has none.
  Eigen::Matrix<double, 6, 6> scaled = Eigen::Matrix<double, 6, 6>::Identity();
  for (Eigen::Index i = 0; i < sum.rows(); ++i) {
    if (!(moment(i, i) > 0.0) && sum(i, i) != 0.0) {
      return std::nullopt;
    }
    for (Eigen::Index j = 0; j < sum.cols(); ++j) {
      const double size = std::sqrt(moment(i, i) * moment(j, j));
      scaled(i, j) = size > 0.0 ? sum(i, j) / size : i == j ? 1.0 : 0.0;
    }
  }
  Eigen::Matrix<double, 6, 6> root;
  return cholesky(scaled, &root) ? std::optional(sum) : std::nullopt;
}

ShapePoseCovariance with_bend(const ShapePoseCovariance& bound,
                              const ShapePoseCovariance& bound_on_reduced,
                              const ShapePoseCovariance& moment) {
  if (!bound.allFinite()) {  // the estimate itself is not held
    return bound;
  }
  return bend_added(bound, bound_on_reduced, moment).value_or(moment);
}

}  // namespace palpate
