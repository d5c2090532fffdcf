// A curve of two cubics that join at a knot with two continuous derivatives, and its fit by least
// orthogonal distances.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// C(t) = sum c_k t^k, plus bend (t - knot)^3 for t > knot. This covers all pairs of cubics in one
/// parameter whose second derivatives are continuous at the joint.
struct KnottedCubic {
  Eigen::Matrix<double, 2, 4> coefficients = Eigen::Matrix<double, 2, 4>::Zero();
  Vec2 bend = Vec2::Zero();  ///< 0 for a single cubic
  double knot = 0.0;

  Vec2 position(double t) const;
  /// Unit normal, to the left of increasing t.
  Vec2 left(double t) const;
};

struct KnottedCubicFit {
  KnottedCubic curve;     ///< in the normalised frame of FitData; t runs over about [-1, 1]
  std::vector<double> t;  ///< of the foot of every point
  double chi2 = 0.0;
  int side = 0;  ///< side of the tip centres: +1 left of increasing t, -1 right
};

/// The most likely single cubic through the points of one patch. The starts are the recogniser's
/// fits of the spline and of the polynomial classes within it. Needs at least 8 points. O(points).
KnottedCubicFit fit_single_cubic(const FitData& data);

/// Improves `start` with its knot held fixed: the coefficients, and also the bend if `bends`.
/// O(points).
KnottedCubicFit refine_knotted(std::span<const FitPoint> points, const KnottedCubicFit& start,
                               bool bends);

}  // namespace palpate
