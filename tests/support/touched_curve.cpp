#include "tests/support/touched_curve.h"

#include <Eigen/LU>
#include <cassert>
#include <cmath>

namespace palpate::test {

Scene touched_curve(const Curve& curve, const Pose2& world_T_curve, std::span<const Stroke> strokes,
                    double sigma_m, std::mt19937_64& rng) {
  Scene scene;
  scene.curve_class = class_of(curve);
  scene.values = parameters(curve);
  scene.world_T_curve = world_T_curve;
  scene.sigma_m = sigma_m;
  std::normal_distribution<double> noise(0.0, 1.0);
  for (const Stroke& stroke : strokes) {
    std::vector<Vec2> samples;
    std::vector<double> places;
    for (int i = 0; i < stroke.count; ++i) {
      const double along = stroke.count > 1
                               ? stroke.direction * stroke.length_m *
                                     (static_cast<double>(i) / (stroke.count - 1) - 0.5)
                               : 0.0;
      const double t = parameter_at_arc_length(curve, stroke.centre_t, along);
      const double dx = noise(rng);
      const double dy = noise(rng);
      samples.push_back(world_T_curve * position(curve, t) + sigma_m * Vec2(dx, dy));
      places.push_back(t);
    }
    scene.patches.push_back(std::move(samples));
    scene.t.push_back(std::move(places));
  }
  return scene;
}

Eigen::MatrixXd bound_of(const Scene& scene) {
  const std::optional<Curve> curve = make_curve(scene.curve_class, scene.values);
  assert(curve);
  const auto letters = static_cast<Eigen::Index>(parameter_letters(scene.curve_class).size());
  const Eigen::Index free_angle = pose_symmetry(scene.curve_class) == 0 ? 1 : 0;
  const Eigen::Index unknowns = letters + 3 - free_angle;
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(unknowns, unknowns);
  for (const std::vector<double>& patch : scene.t) {
    for (const double t : patch) {
      const CurveDerivatives d = derivatives(*curve, t);
      const Vec2 normal = left_of(d.first).normalized();
      Eigen::VectorXd row(letters + 3);
      row.head(letters) =
          (normal.transpose() * position_by_parameters(*curve, t)).transpose().head(letters);
      const Vec2 in_world = scene.world_T_curve.rotate(normal);
      row[letters] = in_world.x();
      row[letters + 1] = in_world.y();
      row[letters + 2] = normal.dot(left_of(d.position));
      information += row.head(unknowns) * row.head(unknowns).transpose();
    }
  }
  // In natural units the inverse is as well conditioned as the scene is.
  const Eigen::VectorXd sizes = natural_sizes(scene).head(unknowns);
  const Eigen::MatrixXd scaled = sizes.asDiagonal() * information * sizes.asDiagonal();
  Eigen::MatrixXd bound = Eigen::MatrixXd::Zero(letters + 3, letters + 3);
  bound.topLeftCorner(unknowns, unknowns) =
      scene.sigma_m * scene.sigma_m * sizes.asDiagonal() * scaled.inverse() * sizes.asDiagonal();
  return bound;
}

Eigen::VectorXd natural_sizes(const Scene& scene) {
  const auto letters = static_cast<Eigen::Index>(parameter_letters(scene.curve_class).size());
  Vec2 low = scene.patches.front().front();
  Vec2 high = low;
  for (const std::vector<Vec2>& patch : scene.patches) {
    for (const Vec2& p : patch) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  Eigen::VectorXd sizes(letters + 3);
  for (Eigen::Index k = 0; k < letters; ++k) {
    sizes[k] = scene.values[k] != 0.0 ? std::abs(scene.values[k]) : 1.0;
  }
  sizes[letters] = sizes[letters + 1] = 0.5 * (high - low).norm();
  sizes[letters + 2] = 1.0;
  return sizes;
}

}  // namespace palpate::test
