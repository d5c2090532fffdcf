// The bend of a valley against all points and their global feet.
#include "core/recognition/bend.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <iostream>

#include "core/curves/curve.h"
#include "core/recognition/determined.h"
#include "core/recognition/weigh.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// Offsets from all points of the fitted curve to the one with `change` added to shape and pose,
/// over their noise: to the nearest feet of all.
std::optional<Eigen::VectorXd> offsets(const CanonicalFit& fit, const FitData& data,
                                       double inflation, const Eigen::VectorXd& change) {
  const Eigen::Index letters = change.size() - 3;
  const Curve curve = *make_curve(fit.shape.curve_class, fit.shape.values);
  Eigen::Vector3d values = fit.shape.values;
  values.head(letters) += change.head(letters);
  const auto moved = make_curve(fit.shape.curve_class, values);
  if (!moved) {
    return std::nullopt;
  }
  const Pose2 pose{fit.world_T_curve.x + change[letters], fit.world_T_curve.y + change[letters + 1],
                   fit.world_T_curve.theta + change[letters + 2]};
  Eigen::VectorXd result(static_cast<Eigen::Index>(data.points.size()));
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const Vec2 world = fit.world_T_curve * position(curve, fit.points[i].t);
    const FootPoint foot = foot_point(*moved, pose.to_local(world));
    const Vec2 away = pose * position(*moved, foot.t) - world;
    result[static_cast<Eigen::Index>(i)] =
        std::copysign(away.norm(), away.dot(fit.points[i].normal)) * data.points[i].inverse_sigma /
        data.scale / std::sqrt(inflation);
  }
  return result;
}

/// Of all points' offsets by shape and pose, in deviations.
Eigen::MatrixXd jacobian(const CanonicalFit& fit, const FitData& data) {
  const Eigen::Index n = fit.covariance.rows();
  const Curve curve = *make_curve(fit.shape.curve_class, fit.shape.values);
  Eigen::MatrixXd result(static_cast<Eigen::Index>(data.points.size()), n);
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const FittedPoint& point = fit.points[i];
    const Vec2 lever = fit.world_T_curve.rotate(position(curve, point.t));
    const Eigen::Vector3d by_shape = position_by_parameters(curve, point.t).transpose() *
                                     fit.world_T_curve.rotate_back(point.normal);
    const auto row = static_cast<Eigen::Index>(i);
    result.row(row).head(n - 3) = by_shape.head(n - 3).transpose();
    result.row(row).tail<3>() << point.normal.x(), point.normal.y(),
        point.normal.dot(left_of(lever));
    result.row(row) *= data.points[i].inverse_sigma / data.scale;
  }
  return result * fit.covariance.diagonal().cwiseSqrt().asDiagonal();
}

TEST(Bend, IsThatOfAllPoints) {
  std::mt19937_64 rng = test::test_rng();
  int compared = 0;
  int different = 0;
  double largest_unasked = 0.0;
  double largest_difference = 0.0;
  for (const CurveClass curve_class : kCurveClasses) {
    if (curve_class == CurveClass::Line) {
      continue;  // turns and shifts without a bend
    }
    for (const double level : {1e-5, 1e-4, 1e-3}) {
      for (int patches = 1; patches <= 3; ++patches) {
        for (int i = 0; i < test::stress_count(10); ++i) {
          test::SceneOptions options;
          options.patches = patches;
          options.sigma_over_size = level;
          const test::Scene scene = test::random_scene(curve_class, options, rng);
          const Weighing w =
              weigh(test::fit_data(scene, scene.sigma_m), true, {}, RecognizerOptions{});
          const auto& fit = w.canonical[static_cast<std::size_t>(curve_class)];
          if (!fit || w.best != curve_class ||
              !is_determined(fit->shape, fit->covariance, w.data.scale, 0.3)) {
            continue;
          }
          const auto bend = bend_of(*fit, w.data, w.inflation);
          const Eigen::MatrixXd rows = jacobian(*fit, w.data);
          const Eigen::Index k = loosest_component(fit->shape, fit->covariance, w.data.scale).index;
          const Eigen::VectorXd step =
              2.0 * std::sqrt(w.inflation / fit->covariance(k, k)) * fit->covariance.col(k);
          const auto forth = offsets(*fit, w.data, w.inflation, step);
          const auto back = offsets(*fit, w.data, w.inflation, -step);
          if (!bend || !forth || !back) {
            continue;
          }
          const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(rows);
          const Eigen::VectorXd exact = qr.solve(0.5 * (*forth + *back));
          const double ratio = 3.0 / 16.0 * (rows * exact).squaredNorm();
          if (bend->displacement.isZero(0.0)) {
            largest_unasked = std::max(largest_unasked, ratio);
            continue;
          }
          const Eigen::VectorXd deviations = (w.inflation * fit->covariance.diagonal()).cwiseSqrt();
          const Eigen::VectorXd found =
              (deviations.array() > 0.0).select(bend->displacement.cwiseQuotient(deviations), 0.0);
          const double difference =
              (rows * (found - exact)).norm() / std::max(1.0, (rows * exact).norm());
          ++compared;
          different += difference > 0.1 ? 1 : 0;
          largest_difference = std::max(largest_difference, difference);
          EXPECT_NEAR(bend->variance_ratio, ratio, 0.5 * ratio + 0.1) << name_of(curve_class);
        }
      }
    }
  }
  std::cout << "compared: " << compared << ", different: " << different << ", largest difference "
            << largest_difference << ", largest variance ratio where not asked: " << largest_unasked
            << "\n";
  if (!test::counts_tell()) {
    return;
  }
  EXPECT_GT(compared, 100);
  EXPECT_LE(50 * different, compared);  // arcs with a sharp bend between the points asked
  EXPECT_LT(largest_unasked, 0.01);
}

TEST(Bend, AddsItsSecondMoment) {
  Bend bend;
  bend.displacement = ShapePoseVector::Zero(3);
  bend.displacement << 4.0, 0.0, -8.0;
  const ShapePoseCovariance sum = with_bend(ShapePoseCovariance::Identity(3, 3), bend);
  Eigen::Matrix3d expected;
  expected << 4.0, 0.0, -6.0, 0.0, 1.0, 0.0, -6.0, 0.0, 13.0;
  EXPECT_TRUE(sum.isApprox(expected));
}

}  // namespace
}  // namespace palpate
