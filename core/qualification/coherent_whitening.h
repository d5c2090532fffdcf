// Residuals with noise that is partly coherent along a stroke, made white.
#pragma once

#include <Eigen/Core>
#include <span>

namespace palpate {

/// Covariance of residuals over the variance of their white noise: I + ratio^2 exp(-|s_i - s_j| /
/// length) within a stroke, s the arc length; none between strokes.
struct Coherence {
  double ratio = 0.0;  ///< standard deviation of the coherent part over that of the white one
  double length_m = 1.0;
};

/// One stroke's samples in the order of their places. Those set aside as spikes have no weight.
struct StrokePlaces {
  Eigen::Index begin = 0;  ///< rows of the matrix that is made white
  Eigen::Index end = 0;
};

/// Multiplies all columns by the inverse of the covariance's lower root, row by row of the
/// recursion of Kalman's filter: exp(-s) is Markov's law, so that n rows cost O(n) and not n^3.
/// Rows whose `used` is 0 become 0. Returns the logarithm of the covariance's determinant. `arc_m`
/// rises within each stroke.
double whiten(const Coherence& coherence, std::span<const StrokePlaces> strokes,
              std::span<const double> arc_m, std::span<const char> used, Eigen::MatrixXd& columns);

}  // namespace palpate
