// The share of a class's prior that is touched far out on an arm.
#pragma once

#include "core/recognition/prior/touched_coordinates.h"

namespace palpate {

/// One part in ten is touched so: twice as many as places lie beyond the ends that the laws of the
/// bend tell of parts. (With half of them a straight edge read in coarse steps was no longer
/// certain to be one: sparse_parts_test.)
inline constexpr double kShareOfArms = 0.1;

/// Of conics and cubical parabola. An ellipse's are those of its tip: far away from its other end
/// it is a parabola. What is far out on an arm of a spline is an arc, which has half of its prior
/// (arc_coordinates.h). A semi-cubical parabola's arms bend so slowly that with a share in them it
/// equals the flat side of a long ellipse (real_recordings_test).
bool has_arms(CurveClass curve_class);

/// log(size of the part / size expected): the part reaches as far as the place that is touched.
double log_size_of_arms(CurveClass curve_class, const TouchedVector& z);

/// log of (density of these parts at z / density that a normal law of prior_widths has at the
/// prior's centre).
double log_prior_of_arms(CurveClass curve_class, const TouchedVector& z);

/// Derivatives of it by the coordinates.
TouchedVector gradient_of_arms(CurveClass curve_class, const TouchedVector& z);

/// Width of the law of coordinate `k`, as prior_widths: the slope at the bend, the place (of a
/// hyperbola y / b, of an ellipse the slope against its tip).
double width_on_arms(CurveClass curve_class, int k);

}  // namespace palpate
