// The cubic spline segment from three or more points: the least squares (50), from starts in all of
// its domain.
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
  /// Number of best starts passed to the solver, and of solutions passed to the refinement.
  int starts = 6;
  int refined = 3;
};

/// One minimum of (50), with c in closed form.
struct SplineSolution {
  Eigen::Vector3d parameters = Eigen::Vector3d::Zero();  ///< (a, b, c)
  double orientation = 0.0;  ///< of the canonical x axis in the frame of the tangent angles [rad]
  double cost = 0.0;         ///< sum of squared residuals of (49), each at most 6
  double c_spread = 0.0;     ///< relative disagreement between the c of the points; 0 = they agree
};

/// Minima of (50) over (orientation, a, b), best first by cost and by agreement of c. The paper's
/// slope lambda1 is an orientation here, over the full circle, whose two halves are the two signs
/// of L. The starts are on a grid over (orientation, arctan b), where a^2 follows from a quadratic.
/// Needs three points; at most six are used, spread evenly over those given.
std::vector<SplineSolution> spline_least_squares(std::span<const MeasuredGeometry> points,
                                                 const SplineOptions& options = {});

/// The most likely spline: refines the solutions of (50) on all points (fit_semi_signature) and
/// returns the one with the smallest chi-square. NoRealRoot if (50) has no start.
SemiSignatureFit fit_cubic_spline(std::span<const MeasuredGeometry> points,
                                  const SplineOptions& options = {});

}  // namespace palpate
