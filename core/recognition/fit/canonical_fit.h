// From the coordinates of the fit to canonical shape, pose, contacts and their covariance.
#pragma once

#include <optional>
#include <vector>

#include "core/curves/shape_parameters.h"
#include "core/recognition/fit/class_fits.h"

namespace palpate {

/// A contact point's place on the fitted curve.
struct FittedPoint {
  double t = 0.0;              ///< canonical curve parameter
  double residual = 0.0;       ///< signed distance less tip radius, in units of sigma
  Vec2 normal = Vec2::Zero();  ///< unit normal at the foot point, world frame
  /// Of a measured normal: how far the curve's is turned from it, in deviations, and the inverse of
  /// that deviation, which holds that of the foot's place. 0 without. [1/rad]
  double normal_residual = 0.0;
  double normal_weight = 0.0;
};

struct CanonicalFit {
  ShapeParameters shape;
  Pose2 world_T_curve;
  /// Inverse of the Fisher information of [shape; x; y; theta] at the fit, for the points' stated
  /// sigmas: the Kanatani-Cramer-Rao bound. What the pose symmetry leaves free (a circle's theta, a
  /// line's position along itself) is fixed by convention and has variance 0.
  ShapePoseCovariance covariance;
  std::vector<FittedPoint> points;
};

/// Of n components of which nothing is known: infinite variances, no covariances.
ShapePoseCovariance untold_covariance(Eigen::Index n);

/// Inverse of an information matrix of known rank; null directions have variance 0.
struct InverseInformation {
  ShapePoseCovariance covariance;
  double log_determinant = 0.0;  ///< of the information, but for its null directions
};
InverseInformation inverse_information(const ShapePoseCovariance& information, int rank);

/// Shape and pose alone.
struct CanonicalPlace {
  ShapeParameters shape;
  Pose2 world_T_curve;
};

/// Those of to_canonical(), where there is such a curve.
std::optional<CanonicalPlace> canonical_place(const ClassFit& fit, const FitData& data);

/// `data`: all points where `fit` is refined on all, otherwise the reduced ones, which carry the
/// same information. nullopt where there is no such curve: a class at its limit, a circle as flat
/// as a line, a parabola or cubic without extent across its axis.
std::optional<CanonicalFit> to_canonical(const ClassFit& fit, const FitData& data);

}  // namespace palpate
