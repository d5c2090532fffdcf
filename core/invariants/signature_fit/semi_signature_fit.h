// The most likely curve of a class for tangent angles, kappa and kappa_s of any number of points:
// the semi-signature curve (section 2.3) of the class laid through the measurements.
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
  /// Standard deviation added in quadrature to each measurement: of the angle in radians, of kappa
  /// and kappa_s relative to the point's own size max(|kappa|, sqrt|kappa_s|) and its square. The
  /// default is what exact values in doubles carry; estimates with a known bias ask for more.
  double relative_floor = 1e-12;
  int max_iterations = 60;
  /// A fit ends where the next step would take less than this part of chi-square off it. The
  /// default is what doubles resolve.
  double relative_decrease = 1e-13;
  double absolute_decrease = 0.0;  ///< or less than this
  /// It ends, too, where the iterations that are left, each as good as the next one promises to be,
  /// would leave chi-square above this: the class does not explain the points, and by how little is
  /// not asked.
  double hopeless_chi2 = std::numeric_limits<double>::infinity();
};

/// Where a fit begins.
struct CurveStart {
  Eigen::Vector3d parameters = Eigen::Vector3d::Zero();  ///< order of parameter_letters(class)
  double orientation = 0.0;  ///< of the canonical x axis in the frame of the tangent angles [rad]
};

struct SemiSignatureFit {
  InvariantStatus status = InvariantStatus::TooFewPoints;
  CurveClass curve_class = CurveClass::Unclassified;
  Eigen::Vector3d parameters = Eigen::Vector3d::Zero();  ///< order of parameter_letters(class)
  double orientation = 0.0;  ///< of the canonical x axis in the frame of the tangent angles [rad]
  /// Of [parameters; orientation]: the leading (count + 1) rows and columns.
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  double chi2 = 0.0;
  int dof = 0;  ///< 3 per point, less one parameter t per point, the shape and the orientation
  std::vector<LocalParameter> places;  ///< one per point
};

/// Minimises the sum over the points of the squared, whitened differences of (angle, kappa,
/// kappa_s) over shape, orientation and one curve parameter a point, from the given start. For
/// ellipse, parabola, hyperbola, cubical and semi-cubical parabola and cubic spline. Regular at
/// inflections, vertices and vertical canonical tangents. Each step costs O(points); the t are
/// eliminated.
SemiSignatureFit fit_semi_signature(CurveClass curve_class,
                                    std::span<const MeasuredGeometry> points,
                                    const Eigen::Vector3d& start_parameters,
                                    double start_orientation,
                                    const SemiSignatureOptions& options = {});

/// The `keep` of the starts that leave least unexplained where each point lies at the best of its
/// candidate_parameters, the best first. A point counts by the logarithm of its chi-square: at a
/// start the points that fit tell more than those that do not.
std::vector<CurveStart> best_starts(CurveClass curve_class,
                                    std::span<const MeasuredGeometry> points,
                                    std::vector<CurveStart> starts, std::size_t keep,
                                    const SemiSignatureOptions& options = {});

}  // namespace palpate
