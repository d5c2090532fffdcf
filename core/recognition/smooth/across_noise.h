// Noise that is longer one way: what of it lies across a curve counts.
#pragma once

#include "core/recognition/smooth/smooth_model.h"

namespace palpate {

/// Weighs a point that brings a covariance C by n . C n, `n` the curve's unit normal there.
/// `rounding`: no noise is smaller, normalised.
void weigh_across(const Vec2& n, double rounding, PointDetail* detail, FitPoint* point);

/// Weighs points that bring a covariance by what of it lies across the smooth model's path. Those
/// of which no polynomial tells the direction keep their mean noise. Whether any was weighed.
/// O(points).
bool weigh_across_path(const SmoothModel& smooth, FitData* data);

}  // namespace palpate
