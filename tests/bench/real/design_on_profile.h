// Fits a designed curve to a measured profile: the shape is fixed, the pose is fitted.
#pragma once

#include <optional>
#include <span>

#include "core/curves/curve.h"

namespace palpate::bench {

struct DesignOnProfile {
  Pose2 world_T_design;
  bool along_increasing_t = true;  ///< the profile's direction of travel
  double residual_rms_m = 0.0;     ///< of the profile's distances to the design: its figure error
};

/// The pose of `design` with the least squared distances to the profile; nullopt if no start
/// converges. `t_pole`: approximate place on the design of the profile's middle, up to the design's
/// mirror symmetry t -> -t.
std::optional<DesignOnProfile> lay_on(const Curve& design, double t_pole,
                                      std::span<const Vec2> profile);

/// The design's geometry at the point nearest to a world point; signs by the profile's travel.
LocalGeometry design_at(const Curve& design, const DesignOnProfile& laid, const Vec2& world_point);

}  // namespace palpate::bench
