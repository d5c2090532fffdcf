// A class that is given: its least orthogonal distances to all points, whatever their order.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "core/curves/pose2.h"
#include "core/curves/shape_parameters.h"
#include "core/recognition/given/given_point.h"

namespace palpate {

struct GivenOptions {
  double sigma_m = 0.0;  ///< noise of points that bring none; 0 = estimate it [m]
};

enum class GivenStatus {
  Fitted,
  NotFinite,      ///< a position, noise, normal or tip radius is not finite, or negative
  TooFewPoints,   ///< fewer different points, and normals in use, than the class has unknowns
  Collinear,      ///< all on one straight line: no curve is determined
  AtLimit,        ///< the squares fall all the way to where the class ends: it has no best curve
  NotDetermined,  ///< a best curve, but others fit alike: what is told of it is one of many
};

/// Lower-case words ("too few points").
std::string_view name_of(GivenStatus status);

struct GivenResidual {
  double t = 0.0;           ///< canonical parameter of the foot point
  double distance_m = 0.0;  ///< signed, positive left of increasing t; less the tip radius
  Vec2 foot_m = Vec2::Zero();
  /// The measured normal's direction less the curve's, either way round, in (-pi/2, pi/2]; NaN
  /// where none is measured, or the curve has none there. [rad]
  double normal_rad = std::numeric_limits<double>::quiet_NaN();
};

struct GivenFit {
  GivenStatus status = GivenStatus::NotFinite;
  ShapeParameters shape;  ///< meaningful where Fitted or NotDetermined, as all below
  Pose2 world_T_curve;
  /// The Kanatani-Cramer-Rao bound for the noise stated or estimated. What the pose symmetry leaves
  /// free has variance 0; all is infinite where no noise is known and none can be estimated.
  ShapePoseCovariance covariance;
  std::vector<GivenResidual> residuals;  ///< in the order of the points
  double rms_m = 0.0;                    ///< root mean square distance of the points in use
  double peak_to_valley_m = 0.0;         ///< largest less smallest signed distance of these
  double chi2 = 0.0;          ///< sum of squares over stated variances; over the estimated one: dof
  bool sigma_stated = false;  ///< for every point: only then chi2 says whether the class is right
  double sigma_m = 0.0;       ///< root mean square of the noise stated, or the estimated one
  int dof = 0;                ///< points and normals in use less unknowns
  std::size_t used = 0;       ///< points
  std::size_t normals = 0;    ///< in use; 0 where a point's noise is not known
  int side = 0;  ///< tip centres lie left (+1) or right (-1) of increasing t; 0 without tips
  /// Largest element of J^T r beside the norms of its column of J and of r: 0 at a stationary
  /// point.
  double stationarity = 0.0;
};

/// Least squares of the signed orthogonal distances over all curves of the class, to rounding of
/// the answer. A measured normal adds the square of its angle to the curve's normal over its
/// deviation, which holds that of the foot's place too (noise along the curve puts the foot where
/// the curve has turned on); a covariance C weighs its point by 1 / (n . C n), n the curve's normal
/// at its foot point, as found, not as sought: then the estimate has no bias by the weights' own
/// slope. Of several minima the lowest that the starts of every class's own search lead to.
GivenFit fit_given_class(CurveClass curve_class, std::span<const GivenPoint> points,
                         const GivenOptions& options = {});

}  // namespace palpate
