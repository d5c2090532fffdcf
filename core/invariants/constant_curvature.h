// Tests for lines and circles, which the paper does not treat: kappa_s = 0 and kappa equal
// everywhere.
#pragma once

#include <span>

#include "core/invariants/invariant_status.h"
#include "core/invariants/measured_geometry.h"

namespace palpate {

struct ConstantCurvature {
  InvariantStatus status = InvariantStatus::TooFewPoints;
  double kappa = 0.0;        ///< weighted mean of |curvature| [1/m]
  double variance = 0.0;     ///< of kappa [1/m^2]
  double circle_chi2 = 0.0;  ///< of the hypothesis "kappa constant, kappa_s = 0"
  int circle_dof = 0;        ///< 2 points - 1
  double line_chi2 = 0.0;    ///< of the hypothesis "kappa = 0, kappa_s = 0, tangents parallel"
  int line_dof = 0;          ///< 3 points - 1
};

/// The direction of travel may differ from patch to patch. Within a patch the sign of kappa must
/// agree.
ConstantCurvature fit_constant_curvature(std::span<const MeasuredGeometry> points);

}  // namespace palpate
