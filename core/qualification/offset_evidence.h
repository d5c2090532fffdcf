// How many harmonics, how much noise and how coherent: weighed by their evidence.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/qualification/coherent_whitening.h"
#include "core/qualification/probe_character.h"

namespace palpate {

/// A linear model of the residuals about a place: residual = flat * x + offset basis * c + noise.
/// Nothing is expected of x; the harmonics of c (not its constant) are normal about 0, of a
/// standard deviation that is sought along.
struct OffsetModel {
  Eigen::VectorXd residual_m;
  Eigen::MatrixXd flat;   ///< poses, and the lag where it is sought
  Eigen::MatrixXd basis;  ///< offset_basis of the highest order
  std::vector<StrokePlaces> strokes;
  std::vector<double> arc_m;
  std::vector<char> used;
  double least_noise_m = 0.0;  ///< what rounding leaves of samples without noise [m]
};

struct OffsetEvidence {
  int order = 0;                      ///< the lowest that no higher one beats by a factor of 3
  std::vector<double> probabilities;  ///< of order 0 (with 1, which is none), 2, 3, ...
  /// Given that order, means over all else and their deviations:
  Estimate sigma_m;
  Estimate deviation_m;
  Estimate deviation_length_m;
  double harmonic_m = 0.0;  ///< standard deviation that the harmonics are expected to have [m]
  Coherence coherence;      ///< of the most probable noise
  /// Of the coefficients: what not knowing noise and coherence adds to the covariance.
  Eigen::MatrixXd spread_m2;
};

/// Exact but for the grid: given noise, coherence and the harmonics' size, all integrals are normal
/// ones, and that over the noise is Student's. Needs more used samples than columns and two;
/// nullopt where the numbers leave a double's range all the same.
std::optional<OffsetEvidence> weigh_offsets(const OffsetModel& model);

}  // namespace palpate
