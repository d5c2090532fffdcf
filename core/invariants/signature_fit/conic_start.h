// Orientation of a conic whose shape is known from its invariants: the start of a fit.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/curves/curve_class.h"
#include "core/invariants/measured_geometry.h"
#include "core/invariants/signature_fit/semi_signature_fit.h"

namespace palpate {

/// Orientation of the canonical x axis in the frame of the tangent angles [rad]. Each point gives
/// one, from its t (section 5.3, in a form that is safe for either sign) and its tangent angle.
/// They are averaged on the circle of directions, modulo the symmetry of the class. For ellipse,
/// parabola and hyperbola, and for points with kappa != 0.
double conic_orientation(CurveClass curve_class, const Eigen::Vector3d& parameters,
                         std::span<const MeasuredGeometry> points);

/// The best combinations of the given shapes with orientations: that of conic_orientation, and
/// others around it, because conic_orientation can be completely wrong if kappa_s is noise.
std::vector<CurveStart> conic_starts(CurveClass curve_class,
                                     std::span<const Eigen::Vector3d> shapes,
                                     std::span<const MeasuredGeometry> points);

}  // namespace palpate
