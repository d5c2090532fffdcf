// Whitening of residuals whose noise is partly coherent along a stroke.
#pragma once

#include <Eigen/Core>
#include <span>

namespace palpate {

/// Covariance of the residuals divided by the variance of their white noise: I + ratio^2 exp(-|s_i
/// - s_j| / length_m) within a stroke, where s is arc length; 0 between strokes.
struct Coherence {
  double ratio = 0.0;  ///< standard deviation of the coherent part over that of the white part
  double length_m = 1.0;
};

/// The rows of one stroke, ordered by place. Samples removed as spikes have no weight.
struct StrokePlaces {
  Eigen::Index begin = 0;  ///< first row in the matrix to whiten
  Eigen::Index end = 0;
};

/// Multiplies all columns by the inverse of the covariance's lower-triangular root. The covariance
/// is that of a Markov process, so the recursion of the Kalman filter does it in O(n) instead of
/// O(n^3). Rows with `used` = 0 become 0. Returns the logarithm of the covariance's determinant.
/// `arc_m` must increase within each stroke.
double whiten(const Coherence& coherence, std::span<const StrokePlaces> strokes,
              std::span<const double> arc_m, std::span<const char> used, Eigen::MatrixXd& columns);

}  // namespace palpate
