// Invariants of a conic from all points at once: the weighted straight line Ip = Ic2 - Ic1
// |kappa|^(-2/3).
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/invariants/invariant_status.h"
#include "core/invariants/measured_geometry.h"

namespace palpate {

/// (24), (33) and (18) are one equation. With u = |kappa|^(-2/3) and v = Ip(kappa, kappa_s), every
/// point of every conic lies on v = Ic2 - Ic1 u. Ic1 > 0: ellipse; 0: parabola; < 0: hyperbola.
struct ConicLine {
  /// Ok, TooFewPoints (fewer than 2), SignChange, ZeroCurvature, NotFinite, NotConverged, or
  /// PointsTooAlike if the spread of u does not exceed its noise. For PointsTooAlike ic1 = 0, ic2 =
  /// the weighted mean of v, and the variances are infinite.
  InvariantStatus status = InvariantStatus::TooFewPoints;
  double ic1 = 0.0;
  double ic2 = 0.0;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of (ic1, ic2)
  double chi2 = 0.0;  ///< sum of squared residuals over their effective variance
  int dof = 0;        ///< points - 2
  /// The line with ic1 = 0, which is that of a parabola: weighted mean of Ip, its variance and its
  /// chi-square.
  double ip_mean = 0.0;
  double ip_variance = 0.0;
  double ip_chi2 = 0.0;
  int ip_dof = 0;  ///< points - 1
};

/// Fits the line with correlated errors in u and v (York et al. 2004, American Journal of Physics
/// 72(3)). The errors are those of (kappa, kappa_s), with the second-order terms of kappa_s^2,
/// because at a vertex the first-order terms vanish. Points count as independent. O(n) per
/// iteration, a handful of iterations; allocates one buffer of n entries.
ConicLine fit_conic_line(std::span<const MeasuredGeometry> points);

}  // namespace palpate
