// Second moments of shape and pose over the valley of a class's likelihood.
#pragma once

#include <optional>

#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/modes/class_evidence.h"

namespace palpate {

/// E[(x - estimate)(x - estimate)^T] of x = [shape; x; y; theta] over the slices of `evidence`. It
/// includes what a linear covariance leaves out if the valley is wide and bent. It uses the
/// likelihood alone: an uncertainty must hold whatever the prior. Infinite if the valley extends
/// beyond the range of a double. `data`: the points of `evidence`. Metres and radians, world frame.
ShapePoseCovariance second_moment(const CanonicalFit& estimate, const ClassEvidence& evidence,
                                  const FitData& data);

/// Derivatives of [shape; x; y; theta] (metres and radians, world frame) by the coordinates of the
/// evidence's mode, one column each, in units of the prior's widths.
Eigen::Matrix<double, 6, 6> shape_pose_by_coordinates(const ClassEvidence& evidence,
                                                      const FitData& data);

/// `covariance` plus what `moment` has beyond `linear`, the covariance of an unbent valley; nullopt
/// if the result is not a covariance.
std::optional<ShapePoseCovariance> bend_added(const ShapePoseCovariance& covariance,
                                              const ShapePoseCovariance& linear,
                                              const ShapePoseCovariance& moment);

/// The bound of all points plus what the valley's moment adds to the bound of the reduced points,
/// which carry slightly less information. If that is not a covariance, the moment itself; an
/// infinite bound stays one.
ShapePoseCovariance with_bend(const ShapePoseCovariance& bound,
                              const ShapePoseCovariance& bound_on_reduced,
                              const ShapePoseCovariance& moment);

}  // namespace palpate
