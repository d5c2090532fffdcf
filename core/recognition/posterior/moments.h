// Second moments of shape and pose over the valley that a class's likelihood has.
#pragma once

#include <optional>

#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/posterior/class_evidence.h"

namespace palpate {

/// E[(x - estimate)(x - estimate)^T] of x = [shape; x; y; theta] over the slices of `evidence`:
/// what a covariance linear about the estimate leaves out where the valley is wide and bent. By the
/// likelihood alone: an uncertainty must hold whatever the prior.
/// Infinite where the valley goes on beyond what a double holds.
/// `data` as `evidence` was taken from. Metres and radians, world frame.
ShapePoseCovariance second_moment(const CanonicalFit& estimate, const ClassEvidence& evidence,
                                  const FitData& data);

/// How [shape; x; y; theta] (metres and radians, world frame) moves with the coordinates of the
/// evidence's mode, a column for each, in units of the prior's widths.
Eigen::Matrix<double, 6, 6> shape_pose_by_coordinates(const ClassEvidence& evidence,
                                                      const FitData& data);

/// A covariance with what `moment` has beyond `linear`, the covariance that it would be if its
/// valley did not bend; nullopt where that would be no covariance.
std::optional<ShapePoseCovariance> bend_added(const ShapePoseCovariance& covariance,
                                              const ShapePoseCovariance& linear,
                                              const ShapePoseCovariance& moment);

/// The bound of all points with what the valley's moment adds to the bound of the reduced points,
/// which carry a little less; the moment itself where that would be no covariance.
ShapePoseCovariance with_bend(const ShapePoseCovariance& bound,
                              const ShapePoseCovariance& bound_on_reduced,
                              const ShapePoseCovariance& moment);

}  // namespace palpate
