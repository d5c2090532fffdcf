// A frame along a window of samples. In this frame the window is a graph y(x), whatever the
// direction of its tangents in the world.
#pragma once

#include <numbers>
#include <span>

#include "core/curves/pose2.h"
#include "core/local/local_status.h"

namespace palpate {

/// Dimensionless coordinates u along and v across a window. All samples have |u| <= 1.
struct AlignedFrame {
  Vec2 origin = Vec2::Zero();  ///< world point at u = v = 0 [m]
  Vec2 axis = Vec2::UnitX();   ///< unit vector of u, in the direction of travel
  double half_extent_m = 0.0;  ///< world length of one unit of u and v [m]
  double first_u = -1.0;       ///< abscissa of the first sample
  double last_u = 1.0;         ///< abscissa of the last sample
  double backtrack = 0.0;      ///< largest decrease of u below an earlier sample's
  double rounding = 0.0;       ///< bound on the rounding error of u and v

  Vec2 to_frame(const Vec2& world) const {
    const Vec2 d = (world - origin) / half_extent_m;
    return {axis.dot(d), cross(axis, d)};
  }
  Vec2 to_world(const Vec2& uv) const {
    return origin + half_extent_m * (uv.x() * axis + uv.y() * left_of(axis));
  }
};

/// The frame along the principal axis of the samples, oriented by their order, with u = 0 at the
/// middle of their extent. `status` is Ok, TooFewSamples (fewer than two), NotFinite, or NoExtent
/// (the extent is zero up to rounding).
struct AlignedFrameResult {
  LocalStatus status = LocalStatus::TooFewSamples;
  AlignedFrame frame;
};
AlignedFrameResult aligned_frame(std::span<const Vec2> samples);

/// How far noise lets a sample run back behind the one before, in the unit of `sigma`: the
/// difference of two abscissae has the noise sqrt(2) sigma, and six standard deviations reject one
/// in 10^9 neighbours by chance.
inline double most_backtrack(double sigma) { return 6.0 * std::numbers::sqrt2 * sigma; }

/// Checks that the abscissae do not run back by more than noise explains. Ok if the given noise (0
/// = unknown) explains it; also Ok if the noise seen in the residuals explains it and it is at most
/// a tenth of the half extent. Otherwise DoublesBack. Noise in units of u.
LocalStatus check_backtrack(const AlignedFrame& frame, double sigma_given, double sigma_seen);

}  // namespace palpate
