// The paper's noise-free measurement: kappa and kappa_s by finite differences (51), with chords for
// arc lengths and exact tangent angles.
#pragma once

#include "core/invariants/measured_geometry.h"
#include "tests/support/canonical_points.h"

namespace palpate::paper {

/// (51) at t with the neighbours at a chord length on either side that is the fraction `step` of
/// the curve's own size there, 1 / max(|kappa|, sqrt|kappa_s|). Tangent angles are exact. step = 0:
/// exact kappa and kappa_s.
MeasuredGeometry finite_differences(const test::PlacedCurve& curve, double t, double step);

}  // namespace palpate::paper
