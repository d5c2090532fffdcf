// Shapes of conics from which the test of the tangents' rotation starts.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/curves/curve_class.h"
#include "core/invariants/conic_line.h"

namespace palpate {

/// If the sign of Ic1 is not known, neither is its size: several sizes with the line's intercept
/// Ic2, which is known better. `curve_class`: Ellipse or Hyperbola.
std::vector<Eigen::Vector3d> central_shapes(CurveClass curve_class, double ic1,
                                            const ConicLine& line);

/// Ellipses of a few axis ratios that have this curvature half way between the vertices.
std::vector<Eigen::Vector3d> ellipses_curved_by(double kappa);

/// The parabola of the line's mean Ip, if there is one.
std::vector<Eigen::Vector3d> parabola_shapes(const ConicLine& line);

}  // namespace palpate
