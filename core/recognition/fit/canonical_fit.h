// From a class's fit to canonical shape, pose, contacts and their covariance.
#pragma once

#include <optional>
#include <vector>

#include "core/curves/shape_parameters.h"
#include "core/recognition/fit/class_fits.h"

namespace palpate {

/// The place of a contact point on the fitted curve.
struct FittedPoint {
  double t = 0.0;              ///< canonical curve parameter
  double residual = 0.0;       ///< (signed distance - tip radius) / sigma
  Vec2 normal = Vec2::Zero();  ///< unit normal at the foot point, world frame
  /// For a measured normal: the angle to the curve's normal in standard deviations, and 1 / that
  /// standard deviation, which includes the uncertainty of the foot's place. 0 without a normal.
  /// [1; 1/rad]
  double normal_residual = 0.0;
  double normal_weight = 0.0;
  double polynomial_t = 0.0;  ///< parameter of CanonicalFit's polynomials
};

struct CanonicalFit {
  ShapeParameters shape;
  Pose2 world_T_curve;
  /// The Kanatani-Cramer-Rao bound: inverse of the Fisher information of [shape; x; y; theta] at
  /// the fit, for the points' sigmas. What the pose symmetry leaves free (a circle's theta, a
  /// line's position along itself) is fixed by convention and has variance 0.
  ShapePoseCovariance covariance;
  std::vector<FittedPoint> points;
  /// A spline's polynomials, in the normalised frame: beside a cubical parabola, with the vertex
  /// far away, shape and pose have lost digits that these have.
  std::optional<PolynomialCoefficients> polynomial = std::nullopt;
};

/// Chi-square of its points.
double chi2_of(const CanonicalFit& fit);

/// Shape and pose alone.
struct CanonicalPlace {
  ShapeParameters shape;
  Pose2 world_T_curve;
};

/// Shape and pose as to_canonical() gives them; nullopt if there is no such curve.
std::optional<CanonicalPlace> canonical_place(const ClassFit& fit, const FitData& data);

/// `data`: all points if `fit` is refined on all, otherwise the reduced points, which carry the
/// same information. nullopt if there is no such curve: a class at its limit, a circle as flat as a
/// line, a parabola or cubic without extent across its axis.
std::optional<CanonicalFit> to_canonical(const ClassFit& fit, const FitData& data);

}  // namespace palpate
