// The cubic spline segment from three or more points: the least squares (50), started everywhere.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/invariants/invariant_status.h"
#include "core/invariants/measured_geometry.h"
#include "core/invariants/signature_fit/semi_signature_fit.h"

namespace palpate {

struct SplineOptions {
  SemiSignatureOptions refinement;
  /// Best starts handed to the solver, and solutions handed to the refinement.
  int starts = 6;
  int refined = 3;
};

/// One minimum of (50) with its closed-form c.
struct SplineSolution {
  Eigen::Vector3d parameters = Eigen::Vector3d::Zero();  ///< (a, b, c)
  double orientation = 0.0;  ///< of the canonical x axis in the frame of the tangent angles [rad]
  double cost = 0.0;         ///< sum of squared residuals of (49), each at most 6
  double c_spread = 0.0;     ///< disagreement of the points' own c, relative; 0 = they agree
};

/// Minima of (50) over (orientation, a, b), best first by cost and agreement of c. The slope
/// lambda1 of the paper is an orientation here, over the full circle: its two halves are the two
/// signs of L. A grid over (orientation, arctan b), on which a^2 follows from a quadratic, gives
/// the starts. Needs three points; at most eight are used (spread evenly over those given).
std::vector<SplineSolution> spline_least_squares(std::span<const MeasuredGeometry> points,
                                                 const SplineOptions& options = {});

/// The most likely spline: the solutions of (50) refined on all points (fit_semi_signature), the
/// one of least chi-square kept. NoRealRoot where (50) has no start at all.
SemiSignatureFit fit_cubic_spline(std::span<const MeasuredGeometry> points,
                                  const SplineOptions& options = {});

}  // namespace palpate
