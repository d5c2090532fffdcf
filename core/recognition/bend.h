// The bend of a valley of chi-square, which the inverse of the information leaves out.
#pragma once

#include <optional>

#include "core/recognition/canonical_fit.h"
#include "core/recognition/fit_data.h"

namespace palpate {

/// [shape parameters; x; y; theta]; at most 6, no heap.
using ShapePoseVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

/// The valley's bottom is at k s - (k / 2)^2 displacement, where s is the standard deviation of the
/// component of shape and pose that is known the least, the other components following it.
struct Bend {
  /// beta, at two standard deviations either way.
  ShapePoseVector displacement;
  /// The second moment that the bend adds over the bound's variance, along the displacement:
  /// (3/16) beta^T C^-1 beta.
  double variance_ratio = 0.0;
  /// What neither the slope nor the bend describes at two standard deviations, beside what they
  /// describe: the ratio of the squared Mahalanobis distances by with_bend(), the worse side.
  double nonlinearity = 0.0;
};

/// The bend of `inflation` times the covariance of `fit`, which has a point for each of `data`.
/// nullopt where the class ends within two standard deviations (an ellipse whose semi-axes may
/// change places). No displacement where the standard deviation is too small for any bend to show.
/// O(1) but for a sum over the weights: a dozen of the points are asked. See core/README.md,
/// "Evidence".
std::optional<Bend> bend_of(const CanonicalFit& fit, const FitData& data, double inflation);

/// The second moment about the estimate of a valley that bends: C + (3/16) beta beta^T, as k^4 / 16
/// has the mean 3/16.
ShapePoseCovariance with_bend(const ShapePoseCovariance& covariance, const Bend& bend);

}  // namespace palpate
