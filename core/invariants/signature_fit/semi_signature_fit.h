// The most likely curve of a class for tangent angles, kappa and kappa_s of any number of points.
// It fits the semi-signature curve (section 2.3) of the class to the measurements.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>

#include "core/curves/curve_class.h"
#include "core/invariants/invariant_status.h"
#include "core/invariants/measured_geometry.h"
#include "core/invariants/signature_fit/local_parameter.h"

namespace palpate {

struct SemiSignatureOptions {
  /// Standard deviation that is added in quadrature to each measurement: in radians for the angle;
  /// for kappa and kappa_s relative to the point's size max(|kappa|, sqrt|kappa_s|) and to its
  /// square. The default suits exact values in doubles; estimates with a known bias need more.
  double relative_floor = 1e-12;
  int max_iterations = 60;
  /// The fit stops when the next step would reduce chi-square by less than this fraction. The
  /// default is the resolution of doubles.
  double relative_decrease = 1e-13;
  double absolute_decrease = 0.0;  ///< ... or by less than this
  /// The fit also stops if the remaining iterations, each as good as the next one promises to be,
  /// would leave chi-square above this. The class then does not explain the points, and the exact
  /// value is not needed.
  double hopeless_chi2 = std::numeric_limits<double>::infinity();
};

/// Starting values of a fit.
struct CurveStart {
  /// In the order of parameter_letters(class).
  Eigen::Vector3d parameters = Eigen::Vector3d::Zero();
  double orientation = 0.0;  ///< of the canonical x axis in the frame of the tangent angles [rad]
};

struct SemiSignatureFit {
  InvariantStatus status = InvariantStatus::TooFewPoints;
  CurveClass curve_class = CurveClass::Unclassified;
  /// In the order of parameter_letters(class).
  Eigen::Vector3d parameters = Eigen::Vector3d::Zero();
  double orientation = 0.0;  ///< of the canonical x axis in the frame of the tangent angles [rad]
  /// Of [parameters; orientation]: the leading (count + 1) rows and columns.
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  double chi2 = 0.0;
  int dof = 0;  ///< 3 per point, minus one parameter t per point, the shape and the orientation
  std::vector<LocalParameter> places;  ///< one per point
};

/// Keeps a finite fit if it is the better one: with an optimum rather than without, else that with
/// less chi-square.
void keep_better(SemiSignatureFit fit, SemiSignatureFit& best);

/// Minimises the sum over the points of the squared, whitened differences of (angle, kappa,
/// kappa_s) over shape, orientation and one curve parameter per point. For ellipse, parabola,
/// hyperbola, cubical and semi-cubical parabola and cubic spline. Inflections, vertices and
/// vertical canonical tangents are regular. The curve parameters are eliminated, so a step costs
/// O(points).
SemiSignatureFit fit_semi_signature(CurveClass curve_class,
                                    std::span<const MeasuredGeometry> points,
                                    const Eigen::Vector3d& start_parameters,
                                    double start_orientation,
                                    const SemiSignatureOptions& options = {});

/// The `keep` best starts, best first. Each point is placed at the best of its
/// candidate_parameters; a start is better if it leaves less unexplained. A point counts by the
/// logarithm of its chi-square: at a start, the points that fit say more than those that do not.
std::vector<CurveStart> best_starts(CurveClass curve_class,
                                    std::span<const MeasuredGeometry> points,
                                    std::vector<CurveStart> starts, std::size_t keep,
                                    const SemiSignatureOptions& options = {});

}  // namespace palpate
