// Points for the fit of a given class: shifted to the origin, scaled to about unit size, exactly.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/curves/pose2.h"
#include "core/recognition/given/given_point.h"
#include "core/recognition/given/placed/orthogonal_squares.h"

namespace palpate {

/// The points in use, relative to their middle, in units of about their half extent. Differences
/// are computed in double-double, and the unit is a power of 4, so that its square root is exact
/// too. No digit is lost however far from the origin the points lie.
struct LocalPoints {
  Vec2 middle_m = Vec2::Zero();
  double unit_m = 1.0;
  std::vector<std::size_t> index;  ///< of every point in use, its index among all points
  std::vector<WeighedPoint<DoubleDouble>> exact;
  std::vector<Vec2> rough;
  std::size_t normals = 0;  ///< number of normals in use
  /// Rounding error of the coordinates, in local units: no position is known better.
  double rounding = 0.0;
};

/// Takes the points that are not set aside; nullopt if they are all in one place. `weighted`: every
/// point's noise is known, so that weights and normals count; else all weights are 1.
std::optional<LocalPoints> local_points(std::span<const GivenPoint> points, double sigma_m,
                                        bool weighted);

/// Number of different points.
std::size_t different(std::vector<Vec2> points);

/// True if a straight line passes all points within the rounding of their coordinates.
bool on_one_line(const LocalPoints& local);

}  // namespace palpate
