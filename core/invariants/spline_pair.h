// The cubics that are possible for two points: the starts for the least squares of the spline.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/invariants/measured_geometry.h"

namespace palpate {

struct SplineSeed {
  Eigen::Vector3d parameters = Eigen::Vector3d::Zero();  ///< (a, b, c), a > 0
  double orientation = 0.0;  ///< of the canonical x axis in the frame of the tangent angles [rad]
  /// Relative disagreement with kappa and kappa_s of the points, in [0, 1]; 0 = none.
  double disagreement = 0.0;
};

/// The `wanted` best cubics through pairs of `points`, best first: those that agree best with all
/// points. `points` in lengths of their own curvature scale (in_units_of).
///
/// Two points give six numbers. The unknowns are the five of a spline and its two places, minus the
/// free parametrisation, so there are finitely many cubics. In the frame of the tangent of point 1,
/// and with the parameter u that has unit speed there, a cubic with the geometry of point 1 is
///     alpha'(u) = (1 + p u + q u^2, kappa u + m u^2),  m = (kappa_s + 3 kappa p) / 2.
/// For a given u of point 2, its tangent direction is a linear equation for (p, q) and its kappa a
/// quadratic one. Then kappa_s has roots along u, which are found by its changes of sign. All
/// tangents are regular, because neither slopes nor a canonical frame are used.
std::vector<SplineSeed> spline_seeds(std::span<const MeasuredGeometry> points, int wanted);

}  // namespace palpate
