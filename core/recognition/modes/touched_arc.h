// A spline as an arc (core/README.md, "The spline as an arc"): by the second and third derivative
// at the touched place.
#pragma once

#include <optional>
#include <vector>

#include "core/recognition/modes/touched_curve.h"

namespace palpate {

/// A spline's fit as an arc: the touch, with the coordinates and feet alone.
struct TouchedArc {
  Touch touch;
  TouchedCurve curve;
};

/// From the fit's polynomials, so that the vertex may be anywhere; nullopt if it has none.
std::optional<TouchedArc> arc_of(const CanonicalFit& fit, const FitData& data);

/// A parabola as a spline with next to no third derivative, travelled with its t or
/// against it: splines to one side of it are arcs one way round, to the other side the other.
/// nullopt where it is no curve.
std::optional<TouchedArc> arc_of_parabola(const Touch& touch, const TouchedCurve& parabola,
                                          bool with_its_t);

/// Feet by a spline's t as those of the arc about the touched place: by s.
void to_arc_feet(const Curve& spline, double touched_t, std::vector<double>* feet);

/// Feet, chi-square and derivatives of an arc, whose z and starting feet are set. false outside the
/// class, and if a foot has run away.
bool place_arc_on(const Touch& touch, const FitData& data, TouchedCurve* curve);

}  // namespace palpate
