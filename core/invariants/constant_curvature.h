// Lines and circles, which the paper leaves out: kappa_s = 0 and kappa the same everywhere.
#pragma once

#include <span>

#include "core/invariants/invariant_status.h"
#include "core/invariants/measured_geometry.h"

namespace palpate {

struct ConstantCurvature {
  InvariantStatus status = InvariantStatus::TooFewPoints;
  double kappa = 0.0;        ///< weighted mean of the curvature's size, >= 0 [1/m]
  double variance = 0.0;     ///< of kappa [1/m^2]
  double circle_chi2 = 0.0;  ///< of "kappa constant, kappa_s = 0"
  int circle_dof = 0;        ///< 2 points - 1
  double line_chi2 = 0.0;    ///< of "kappa = 0, kappa_s = 0, tangents parallel"
  int line_dof = 0;          ///< 3 points - 1
};

/// The direction of travel may differ between patches: within one the sign of kappa must agree.
ConstantCurvature fit_constant_curvature(std::span<const MeasuredGeometry> points);

}  // namespace palpate
