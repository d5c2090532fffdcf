// Contact points as the fit of a given class sees them: near the origin, of about unit size, exact.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/curves/pose2.h"
#include "core/recognition/given/given_point.h"
#include "core/recognition/given/orthogonal_squares.h"

namespace palpate {

/// The points in use about their middle, in units of about their half extent. Differences are
/// formed in twice a double's precision, and the unit is a power of 4, whose root scales exactly
/// too: nothing of the points is lost however far from the origin they lie.
struct LocalPoints {
  Vec2 middle_m = Vec2::Zero();
  double unit_m = 1.0;
  std::vector<std::size_t> index;  ///< of every point in use
  std::vector<WeighedPoint<DoubleDouble>> exact;
  std::vector<Vec2> rough;
  std::size_t normals = 0;  ///< that count
  /// Rounding of the coordinates: no point is known better.
  double rounding = 0.0;
};

/// The points that are not set aside; nullopt where they are all in one place. `weighted`: every
/// point's noise is known, and its normal counts.
std::optional<LocalPoints> local_points(std::span<const GivenPoint> points, double sigma_m,
                                        bool weighted);

/// How many different ones there are.
std::size_t different(std::vector<Vec2> points);

/// Whether one straight line holds all points to the rounding of their coordinates.
bool on_one_line(const LocalPoints& local);

}  // namespace palpate
