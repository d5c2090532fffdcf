// Where a conic lies, for a shape that its invariants have given: the start of a fit.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/curves/curve_class.h"
#include "core/invariants/measured_geometry.h"
#include "core/invariants/signature_fit/semi_signature_fit.h"

namespace palpate {

/// Orientation of the canonical x axis in the frame of the tangent angles [rad], from each point's
/// t (section 5.3, sign-safe) and tangent angle, averaged over the points on the circle of
/// directions modulo the class's symmetry. For ellipse, parabola and hyperbola; points with kappa
/// != 0.
double conic_orientation(CurveClass curve_class, const Eigen::Vector3d& parameters,
                         std::span<const MeasuredGeometry> points);

/// The best of the shapes in every orientation, conic_orientation's and others around it: where
/// kappa_s is noise its own is off by anything.
std::vector<CurveStart> conic_starts(CurveClass curve_class,
                                     std::span<const Eigen::Vector3d> shapes,
                                     std::span<const MeasuredGeometry> points);

}  // namespace palpate
