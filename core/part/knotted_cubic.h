// A cubic that becomes another one at a knot, two derivatives continuous: least orthogonal
// distances.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// sum c_k t^k + bend (t - knot)^3 beyond the knot: both sides are cubics, and no other pair of
/// cubics in one parameter has a joint of continuous second derivatives.
struct KnottedCubic {
  Eigen::Matrix<double, 2, 4> coefficients = Eigen::Matrix<double, 2, 4>::Zero();
  Vec2 bend = Vec2::Zero();  ///< 0: a single cubic
  double knot = 0.0;

  Vec2 position(double t) const;
  /// Unit normal, to the left of increasing t.
  Vec2 left(double t) const;
};

struct KnottedCubicFit {
  KnottedCubic curve;     ///< normalised frame; t in about [-1, 1] over the points
  std::vector<double> t;  ///< of every point's foot point
  double chi2 = 0.0;
  int side = 0;  ///< where tip centres lie: +1 left of increasing t, -1 right
};

/// The most likely single cubic (the recogniser's polynomial fits, all nested ones as starts) to
/// the points of one patch. At least 8 points. O(points).
KnottedCubicFit fit_single_cubic(const FitData& data);

/// From a start, with the knot held: the coefficients, and the bend too where `bends`. O(points).
KnottedCubicFit refine_knotted(std::span<const FitPoint> points, const KnottedCubicFit& start,
                               bool bends);

}  // namespace palpate
