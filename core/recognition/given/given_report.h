// Fills the public result of a fit: metres, world frame.
#pragma once

#include <span>

#include "core/recognition/given/given_class.h"
#include "core/recognition/given/given_reach.h"
#include "core/recognition/given/local_points.h"

namespace palpate {

/// Sets shape and pose, in metres and the world frame.
void report_place(const PlacedCurve<DoubleDouble>& placed, const LocalPoints& local,
                  ShapeParameters* shape, Pose2* world_T_curve);

/// Sets the covariance, widened by the reach, and returns it for the unknowns (placed_curve.h).
/// Sets NotDetermined where it applies.
ShapePoseCovariance report_covariance(const PlacedCurve<DoubleDouble>& placed,
                                      const Squares<DoubleDouble>& squares,
                                      const LocalPoints& local, const GivenReach& reach,
                                      GivenFit* fit);

/// Sets the residuals of all points, also of those set aside, and rms_m and peak_to_valley_m.
void report_residuals(PlacedCurve<DoubleDouble>* placed, const LocalPoints& local,
                      std::span<const GivenPoint> points, GivenFit* fit);

/// Sets the noise, chi2 and dof, and scales the covariance by an estimated noise. `squares`: sum of
/// squared residuals, over the variances if every noise is stated (`stated`), else in squared local
/// units.
void report_noise(std::span<const GivenPoint> points, const LocalPoints& local, bool stated,
                  double default_sigma_m, double squares, GivenFit* fit);

/// Makes the pose unique: a line runs from the first point to the last; of two equal poses the one
/// with |theta| <= pi/2 is taken.
void settle_pose(std::span<const GivenPoint> points, const LocalPoints& local, GivenFit* fit);

}  // namespace palpate
