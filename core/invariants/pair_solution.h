// What two points leave possible for a cubical or a semi-cubical parabola.
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
  /// The quadratic makes one invariant (Icp2, Iscp2) agree between the points; this is by how much
  /// the other (Icp1, Iscp1) does not: (I(1) - I(2)) / (|I(1)| + |I(2)|), zero for a true root.
  double mismatch = 0.0;
  double mismatch_variance = 0.0;  ///< first order; infinite at a double root
  /// Of the parameters, first order; infinite at a double root.
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

struct PairSolutions {
  /// Ok; PointsTooAlike where the pair leaves the angle free; NoRealRoot; NotThisClass where no
  /// root has admissible parameters; NotFinite.
  InvariantStatus status = InvariantStatus::TooFewPoints;
  int count = 0;
  /// The one whose mismatch is smaller first.
  std::array<PairSolution, 2> solutions;
  /// Of the quadratic, in [-1, 1]; near zero the two roots meet.
  double relative_discriminant = 0.0;
  /// Where the quadratic comes nearest to zero: a seed where noise has removed the root. [rad]
  double nearest_angle = 0.0;
};

}  // namespace palpate
