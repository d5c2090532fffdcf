// The prior of a class, in coordinates relative to the place that was touched.
#pragma once

#include "core/recognition/prior/touched_coordinates.h"

namespace palpate {

/// Width of each coordinate's prior: standard deviation of the normal law with the same height at
/// the centre. Includes offset and turn, which are the same for every class.
TouchedVector prior_widths(Chart chart, const TouchedVector& z);

/// A maximum of the prior; of ellipses the circle.
TouchedVector prior_centre(Chart chart);

/// log of (length whose logarithm is z[0] / size of the part), whatever the rest of the shape: not
/// of an ellipse.
double log_length_over_size(CurveClass curve_class);

/// Where on a part its touches lie. All of a class's prior is about its bend, or all but the share
/// of arms (arms.h).
enum class TouchedAt { Bend, Arms };

/// The z[0] with which a shape of these other coordinates is of the size that is expected.
double expected_log_length(CurveClass curve_class, TouchedAt at, const TouchedVector& z);

/// As log_prior, if all parts were touched there.
double log_prior_touched_at(CurveClass curve_class, TouchedAt at, const TouchedVector& z);

/// log of (prior density at z / density that a normal law of the widths has at its centre): 0 at
/// the prior's centre, but the log of 1 / 2 for a spline that is no arc, and about that of 0.9
/// where there are arms.
double log_prior(Chart chart, const TouchedVector& z);

/// log of the prior's density by the coordinates of shape and place, up to a constant.
double log_density(Chart chart, const TouchedVector& z);

/// Derivatives of log_prior by the coordinates.
TouchedVector log_prior_gradient(Chart chart, const TouchedVector& z);

/// Weights for steps in a heavy tail. Along each coordinate -log_prior lies below a parabola that
/// touches it at z. The weight is that parabola's curvature relative to the normal law of the same
/// width, at most 1. It is small in a heavy tail, where steps with the normal law's curvature would
/// hardly move.
TouchedVector tail_weights(Chart chart, const TouchedVector& z);

}  // namespace palpate
