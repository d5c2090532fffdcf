// The equation of a conic: the way back from its canonical form.
#pragma once

#include "core/curves/algebraic/canonical_conic.h"

namespace palpate::test {

/// The equation of the curve at that pose, with unit norm. For a hyperbola both branches satisfy
/// it. Precondition: one of the five classes above, `values` in the order of parameter_letters.
ConicCoefficients conic_of(CurveClass curve_class, const Eigen::Vector3d& values,
                           const Pose2& world_T_curve);

}  // namespace palpate::test
