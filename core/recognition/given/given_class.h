// Fits a curve of a given class to all points, in any order, by least orthogonal distances.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/curves/pose2.h"
#include "core/curves/shape_parameters.h"
#include "core/recognition/given/given_point.h"
#include "core/recognition/samples/contact_sample.h"

namespace palpate {

struct GivenOptions {
  /// Noise of points that state none; 0 = estimate it from the residuals. [m]
  double sigma_m = 0.0;
  /// Where tips touch that have no known side (GivenPoint). Unknown: the side that fits better, and
  /// of a circle, which fits alike on both, outside.
  TouchedFrom touched_from = TouchedFrom::Unknown;
};

enum class GivenStatus {
  Fitted,
  NotFinite,     ///< a number is not finite, or a noise, normal, covariance or radius is invalid
  TooFewPoints,  ///< fewer different points and used normals than the class has unknowns
  Collinear,     ///< all points lie on one straight line: no curve is determined
  /// No best curve: the sum of squares falls along a valley, and the limit of the class fits no
  /// worse than all that the search has found there.
  AtLimit,
  /// The sum of squares falls along a valley in which the search has not come to an end, and no
  /// other class, nor two parallel lines, that the class turns into fit as well as a curve in it.
  Unfinished,
  /// Rounding of the coordinates leaves a shape parameter as uncertain as its size, or that of the
  /// parameters moves the curve by more than a tenth of the noise.
  NotDetermined,
};

/// Lower-case words ("too few points").
std::string_view name_of(GivenStatus status);

struct GivenResidual {
  double t = 0.0;           ///< parameter of the foot point on the canonical curve, in its unit
  double distance_m = 0.0;  ///< signed, positive left of increasing t; minus the tip radius
  Vec2 foot_m = Vec2::Zero();
  /// Angle from the curve's normal to the measured one, both taken without sign, in (-pi/2, pi/2];
  /// NaN if no normal is measured or the curve has none there. [rad]
  double normal_rad = std::numeric_limits<double>::quiet_NaN();
};

/// Another curve of the class that the sum of squares has a minimum at.
struct GivenRival {
  ShapeParameters shape;
  Pose2 world_T_curve;
  double chi2 = 0.0;  ///< as that of the fit: over the same variances
  /// log odds of the fit over this one by the residuals alone.
  double log_odds = 0.0;
};

struct GivenFit {
  GivenStatus status = GivenStatus::NotFinite;
  ShapeParameters shape;  ///< valid if Fitted or NotDetermined, like all members below
  Pose2 world_T_curve;
  /// Of [shape; x; y; theta]: the Kanatani-Cramer-Rao bound for the noise stated or estimated.
  /// Where the sum of squares rises much less than this bound says, it is widened to what the
  /// residuals allow (given_reach.h). What the pose symmetry leaves free has variance 0. All
  /// variances are infinite if the noise is neither stated nor can be estimated. Of noise that no
  /// two points share: along strokes, count_correlation (given_correlation.h) says what they do.
  ShapePoseCovariance covariance;
  std::vector<GivenResidual> residuals;  ///< in the order of the points
  double rms_m = 0.0;                    ///< root mean square distance of the points in use
  double peak_to_valley_m = 0.0;         ///< largest minus smallest signed distance of these points
  double chi2 = 0.0;  ///< sum of squares over the stated variances; dof if the noise is estimated
  bool sigma_stated = false;  ///< for every point: only then does chi2 test the class
  double sigma_m = 0.0;       ///< root mean square of the stated noise, or the estimated noise
  int dof = 0;                ///< points and normals in use minus unknowns
  std::size_t used = 0;       ///< points in use
  std::size_t normals = 0;    ///< normals in use; 0 unless the noise of every point is known
  int side = 0;  ///< tip centres lie left (+1) or right (-1) of increasing t; 0 without tips
  /// log odds of this side over the other one by the residuals alone: 0 on a circle. Infinite
  /// without tips, if the points or the options tell the side, and if no curve fits on the other.
  double side_log_odds = std::numeric_limits<double>::infinity();
  /// The likeliest other minimum that lies further off than the covariance says; none if there is
  /// none, or if it is told that the tips lie on the other side.
  std::optional<GivenRival> rival;
  /// False if, within three deviations, a shape parameter runs to the end of its class or out of
  /// sight.
  bool bounded = true;
  /// Largest |J_k . r| / (|J_k| |r|) over the columns J_k of the Jacobian, r the residuals: 0 at a
  /// stationary point.
  double stationarity = 0.0;
};

/// True if there is a curve.
inline bool has_curve(const GivenFit& fit) {
  return fit.status == GivenStatus::Fitted || fit.status == GivenStatus::NotDetermined;
}

/// Minimises the sum of squared orthogonal distances over all curves of the class, to rounding of
/// the result. Of several minima it gives the likeliest that the starts lead to (given_search.h).
///
/// A measured normal adds a residual: its angle to the curve's normal over its standard deviation.
/// That deviation includes the position noise along the curve, which puts the foot point where the
/// curve's normal has turned. A point with covariance C has the weight 1 / (n . C n), n the curve's
/// normal at its foot point. The weights are those at the solution and are held fixed while the fit
/// moves: a fit that varied them would be biased towards small weights.
GivenFit fit_given_class(CurveClass curve_class, std::span<const GivenPoint> points,
                         const GivenOptions& options = {});

}  // namespace palpate
