#include "node/tool/drawing/pose_ellipse.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// A normal distribution in the plane lies within this many standard deviations with 95 %
// probability: sqrt(-2 ln 0.05).
constexpr double kPlaneSigmas = 2.4477468306808166;

}  // namespace

std::optional<PoseEllipse> pose_ellipse(const CurveModel& model) {
  const Eigen::Index size = model.covariance.rows();
  if (size == 0 || class_of(model.curve) == CurveClass::Line) return std::nullopt;
  const Eigen::Matrix2d block = model.covariance.block(size - 3, size - 3, 2, 2);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(block);
  const auto half_axis = [&](Eigen::Index i) {
    return kPlaneSigmas * std::sqrt(std::max(axes.eigenvalues()[i], 0.0));
  };
  const Vec2 along = axes.eigenvectors().col(1);
  return PoseEllipse{half_axis(1), half_axis(0), std::atan2(along.y(), along.x())};
}

}  // namespace palpate
