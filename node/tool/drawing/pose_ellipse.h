// How well the place of a curve's frame is known.
#pragma once

#include <optional>

#include "node/tool/drawing/curve_model.h"

namespace palpate {

/// Holds the true origin with a probability of 95 %: by the joint covariance's block of x and y.
struct PoseEllipse {
  double long_m = 0.0;  ///< half axes, long_m >= short_m >= 0
  double short_m = 0.0;
  double angle_rad = 0.0;  ///< of the long one in the world
};

/// nullopt without a covariance.
std::optional<PoseEllipse> pose_ellipse(const CurveModel& model);

}  // namespace palpate
