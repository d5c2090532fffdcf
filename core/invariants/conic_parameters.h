// Shape parameters of a conic from its invariants: (18), (29), (30), (34), (35).
#pragma once

#include <Eigen/Core>

#include "core/invariants/invariant_status.h"

namespace palpate {

/// (a, b) of the canonical form; b = 0 for parabola and circle.
struct ConicParameters {
  InvariantStatus status = InvariantStatus::NotThisClass;
  double a = 0.0;                                        ///< [m]
  double b = 0.0;                                        ///< [m]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of (a, b), first order [m^2]
};

/// (29), (30), a >= b. `covariance` is that of (ic1, ic2). If the data cannot distinguish a from b
/// (the difference of their squares is within its standard deviation of zero, or negative by
/// rounding), the covariance is evaluated one standard deviation away from the circle, where it is
/// finite.
ConicParameters ellipse_parameters(double ic1, double ic2, const Eigen::Matrix2d& covariance);

/// (34), (35); a may be smaller than b.
ConicParameters hyperbola_parameters(double ic1, double ic2, const Eigen::Matrix2d& covariance);

/// a = 1 / (2 Ip^(3/2)), from (18).
ConicParameters parabola_parameters(double ip, double variance);

}  // namespace palpate
