// What is told of a given class's fit, in metres and the world's frame.
#pragma once

#include <span>

#include "core/recognition/given/given_class.h"
#include "core/recognition/given/local_points.h"

namespace palpate {

/// Shape, pose and covariance in metres and the world's frame.
void report_curve(const PlacedCurve<DoubleDouble>& placed, const Squares<DoubleDouble>& squares,
                  const LocalPoints& local, GivenFit* fit);

/// Of all points, those set aside included.
void report_residuals(PlacedCurve<DoubleDouble>* placed, const LocalPoints& local,
                      std::span<const GivenPoint> points, GivenFit* fit);

/// `squares`: over the variances where the noise is stated for all, in units of length otherwise.
void report_noise(std::span<const GivenPoint> points, const LocalPoints& local, bool stated,
                  double default_sigma_m, double squares, GivenFit* fit);

/// A line along the order of the points; of two poses that are the same, the one nearer to the
/// world's axes.
void settle_pose(std::span<const GivenPoint> points, const LocalPoints& local, GivenFit* fit);

}  // namespace palpate
