#include "tests/bench/real/design_on_profile.h"

#include <Eigen/Dense>
#include <cmath>
#include <vector>

namespace palpate::bench {
namespace {

struct Laid {
  Pose2 world_T_design;
  double chi2 = 0.0;  ///< [m^2]
};

/// Gauss-Newton from a start; foot points are followed from sample to sample. A design is far
/// longer than its profile, so it is turned about the profile's `middle` and not about its own
/// distant centre.
std::optional<Laid> lay_from(const Curve& design, Laid at, double t_start,
                             std::span<const Vec2> profile, const Vec2& middle) {
  constexpr int kIterations = 50;
  constexpr double kConverged = 1e-9;  // of the step, in profile lengths and radians
  const auto count = static_cast<Eigen::Index>(profile.size());
  const double length = (profile.back() - profile.front()).norm();
  Eigen::MatrixX3d jacobian(count, 3);
  Eigen::VectorXd distances(count);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    double t = t_start;
    for (Eigen::Index i = 0; i < count; ++i) {
      const Vec2& point = profile[static_cast<std::size_t>(i)];
      const FootPoint foot = foot_point_near(design, at.world_T_design.to_local(point), t);
      t = foot.t;
      const double angle = geometry(design, t).tangent_angle + at.world_T_design.theta;
      const Vec2 normal(-std::sin(angle), std::cos(angle));
      const Vec2 arm = (point - middle) / length;
      distances[i] = foot.distance;
      // Moving the design along the normal brings it closer. Lengths are in profile lengths.
      jacobian.row(i) << normal.x() * length, normal.y() * length, cross(arm, normal) * length;
    }
    at.chi2 = distances.squaredNorm();
    const Eigen::Vector3d step = jacobian.colPivHouseholderQr().solve(distances);
    if (!step.allFinite()) {
      return std::nullopt;
    }
    // Rotate about `middle`, then move.
    const Pose2 about{middle.x(), middle.y(), 0.0};
    const Pose2 move{step[0] * length, step[1] * length, step[2]};
    at.world_T_design = about * move * about.inverse() * at.world_T_design;
    if (step.norm() < kConverged) {
      return at;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<DesignOnProfile> lay_on(const Curve& design, double t_pole,
                                      std::span<const Vec2> profile) {
  const Vec2 chord = profile.back() - profile.front();
  const Vec2 middle = profile[profile.size() / 2];
  const double travel = std::atan2(chord.y(), chord.x());
  std::optional<Laid> best;
  bool best_along = true;
  for (const double t : {t_pole, -t_pole}) {
    for (const bool along : {true, false}) {
      const Laid start{pose_from_contact(design, {t, along}, middle, travel), 0.0};
      const double t_first = foot_point(design, start.world_T_design.to_local(profile.front())).t;
      const auto laid = lay_from(design, start, t_first, profile, middle);
      if (laid && (!best || laid->chi2 < best->chi2)) {
        best = laid;
        best_along = along;
      }
    }
  }
  if (!best) {
    return std::nullopt;
  }
  return DesignOnProfile{best->world_T_design, best_along,
                         std::sqrt(best->chi2 / static_cast<double>(profile.size()))};
}

LocalGeometry design_at(const Curve& design, const DesignOnProfile& laid, const Vec2& world_point) {
  const double t = foot_point(design, laid.world_T_design.to_local(world_point)).t;
  const LocalGeometry local = geometry(design, t);
  return laid.along_increasing_t ? local : reversed(local);
}

}  // namespace palpate::bench
