// The confidence ellipse of the position of a curve's frame.
#pragma once

#include <optional>

#include "node/tool/drawing/curve_model.h"

namespace palpate {

/// Contains the true origin with a probability of 95 %; from the block of x and y of the joint
/// covariance.
struct PoseEllipse {
  double long_m = 0.0;  ///< half axes, long_m >= short_m >= 0
  double short_m = 0.0;
  double angle_rad = 0.0;  ///< direction of the long axis in the world
};

/// nullopt without a covariance, and of a line, whose origin may lie anywhere along it.
std::optional<PoseEllipse> pose_ellipse(const CurveModel& model);

}  // namespace palpate
