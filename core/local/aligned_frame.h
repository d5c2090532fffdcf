// A frame that lies along a window of samples: in it the window is a graph y(x), whatever the
// direction of its tangents in the world.
#pragma once

#include <span>

#include "core/curves/pose2.h"
#include "core/local/local_status.h"

namespace palpate {

/// Dimensionless coordinates along and across a window: `to_frame` maps the samples to |u| <= 1.
struct AlignedFrame {
  Vec2 origin = Vec2::Zero();  ///< world point at u = v = 0 [m]
  Vec2 axis = Vec2::UnitX();   ///< unit vector of u, along the travel
  double half_extent_m = 0.0;  ///< world length of one unit of u and v [m]
  double first_u = -1.0;       ///< abscissa of the first sample
  double last_u = 1.0;         ///< abscissa of the last sample
  double backtrack = 0.0;      ///< largest fall of u below an earlier sample's
  double rounding = 0.0;       ///< bound of the rounding error of u and v

  Vec2 to_frame(const Vec2& world) const {
    const Vec2 d = (world - origin) / half_extent_m;
    return {axis.dot(d), cross(axis, d)};
  }
  Vec2 to_world(const Vec2& uv) const {
    return origin + half_extent_m * (uv.x() * axis + uv.y() * left_of(axis));
  }
};

/// Principal axis of the samples, oriented by their order; u = 0 in the middle of their extent.
/// `status` is Ok, TooFewSamples (below two), NotFinite or NoExtent (zero, up to rounding).
struct AlignedFrameResult {
  LocalStatus status = LocalStatus::TooFewSamples;
  AlignedFrame frame;
};
AlignedFrameResult aligned_frame(std::span<const Vec2> samples);

/// Ok where abscissae run back by no more than the noise given explains (0 = not known), or by no
/// more than the noise that the residuals show and a tenth of the half extent; else DoublesBack.
/// Noise in units of u.
LocalStatus check_backtrack(const AlignedFrame& frame, double sigma_given, double sigma_seen);

}  // namespace palpate
