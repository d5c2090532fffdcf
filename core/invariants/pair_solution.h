// The cubical or semi-cubical parabolas that are possible for two points.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>

#include "core/invariants/canonical_angle.h"
#include "core/invariants/invariant_status.h"
#include "core/invariants/measured_geometry.h"

namespace palpate {

struct PairSolution {
  double angle = 0.0;  ///< canonical tangent angle of point 1 in its direction of travel [rad]
  Eigen::Vector2d parameters = Eigen::Vector2d::Zero();  ///< (a, c) or (a, b)
  /// The quadratic makes one invariant (Icp2, Iscp2) agree between the points. This is the
  /// disagreement of the other (Icp1, Iscp1): (I(1) - I(2)) / (|I(1)| + |I(2)|), zero for a true
  /// root.
  double mismatch = 0.0;
  double mismatch_variance = 0.0;  ///< to first order; infinite at a double root
  /// Of the parameters, to first order; infinite at a double root.
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

struct PairSolutions {
  /// Ok; ZeroCurvature; PointsTooAlike if the pair leaves the angle free; NoRealRoot; NotThisClass
  /// if no root has admissible parameters; NotFinite.
  InvariantStatus status = InvariantStatus::TooFewPoints;
  int count = 0;
  /// The solution with the smaller mismatch first.
  std::array<PairSolution, 2> solutions;
  /// Of the quadratic, in [-1, 1]; near zero the two roots coincide.
  double relative_discriminant = 0.0;
  /// The angle at which the quadratic comes closest to zero: a starting value if noise has removed
  /// the roots. [rad]
  double nearest_angle = 0.0;
};

}  // namespace palpate
