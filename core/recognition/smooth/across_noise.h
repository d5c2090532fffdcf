// Noise that is longer one way: what of it lies across a curve counts.
#pragma once

#include "core/recognition/smooth/smooth_model.h"

namespace palpate {

/// Whether any point brings a covariance, or has one left that is not used.
bool has_covariances(const FitData& data);

/// Weighs a point that brings a covariance C by n . C n, `n` the curve's unit normal there.
/// `rounding`: no noise is smaller, normalised.
void weigh_across(const Vec2& n, double rounding, PointDetail* detail, FitPoint* point);

/// The smooth model of points some of which bring covariances. At first all of their noise is taken
/// for what lies across: by less, a stroke that lies across the long axis would be cut for what its
/// noise leaves. Then they are weighed by what of it lies across the path, and moved along the path
/// by what their distance from it tells of the noise there: what is left along has nothing to do
/// with what lies across (core/README.md, "Refinement and the bound"). And all is smoothed again,
/// until the path stays. Points of which no polynomial tells the direction keep their place and
/// mean noise. `source`: fit_smooth_model's. O(points).
SmoothModel smooth_across(bool sigma_known, const SectionSource& source, FitData* data);

}  // namespace palpate
