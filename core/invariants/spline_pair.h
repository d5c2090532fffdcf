// Cubics that two points leave possible: the starts of the spline's least squares.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/invariants/measured_geometry.h"

namespace palpate {

struct SplineSeed {
  Eigen::Vector3d parameters = Eigen::Vector3d::Zero();  ///< (a, b, c), a > 0
  double orientation = 0.0;   ///< of the canonical x axis in the frame of the tangent angles [rad]
  double disagreement = 0.0;  ///< with the points' kappa and kappa_s, relative, in [0, 1]; 0 = none
};

/// Two points give six numbers for the five unknowns of a spline and its two places, less the free
/// parametrisation: finitely many cubics. A cubic that has point 1's geometry is, with u the
/// parameter that has unit speed there,
///     alpha'(u) = (1 + p u + q u^2, kappa u + m u^2),  m = (kappa_s + 3 kappa p) / 2
/// in the frame of its tangent. For a given u of point 2 its tangent direction is a linear equation
/// for (p, q) and its kappa a quadratic one; kappa_s then has roots along u, found by their change
/// of sign. Regular for all tangents: no slope, no canonical frame. The seeds, best first, are
/// those that agree best with all points. `points` in lengths of their own curvature scale
/// (in_units_of).
std::vector<SplineSeed> spline_seeds(std::span<const MeasuredGeometry> points, int wanted);

}  // namespace palpate
