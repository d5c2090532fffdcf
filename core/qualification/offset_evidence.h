// How many harmonics the offset has, how large the noise is and how coherent: weighed by evidence.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/qualification/coherent_whitening.h"
#include "core/qualification/probe_character.h"

namespace palpate {

/// A linear model of the residuals about a starting point: residual = flat * x + basis * c + noise.
/// x has a flat prior. The harmonics in c (not its constant) have a normal prior about 0, whose
/// standard deviation is estimated too.
struct OffsetModel {
  Eigen::VectorXd residual_m;
  Eigen::MatrixXd flat;   ///< columns of the poses, and of the lag if it is estimated
  Eigen::MatrixXd basis;  ///< offset_basis up to the highest order
  std::vector<StrokePlaces> strokes;
  std::vector<double> arc_m;
  std::vector<char> used;
  double least_noise_m = 0.0;  ///< rounding error of samples without noise [m]
};

struct OffsetEvidence {
  int order = 0;  ///< the lowest order that no higher one beats by a factor of 3
  std::vector<double> probabilities;  ///< of order 0 (or 1, which adds nothing), 2, 3, ...
  /// Given that order: means and standard deviations over everything else.
  Estimate sigma_m;
  Estimate deviation_m;
  Estimate deviation_length_m;
  double harmonic_m = 0.0;  ///< prior standard deviation of the harmonics [m]
  Coherence coherence;      ///< the most probable one
  /// Covariance that the uncertainty of noise and coherence adds to that of the coefficients, given
  /// that order.
  Eigen::MatrixXd spread_m2;
  /// The other orders' part of the coefficients' second moments about those of this order: an arc
  /// that is touched alone may bend as much by the lobes that it has as by lobes of one more order
  /// and another constant.
  Eigen::MatrixXd other_orders_m2;
};

/// The covariance of the coefficients over all orders, from that given the order.
Eigen::MatrixXd over_all_orders(const Eigen::MatrixXd& of_order_m2, const OffsetEvidence& evidence);

/// The evidence of each order. Exact except for the grid: given noise, coherence and the size of
/// the harmonics, all integrals are Gaussian; the integral over the noise leads to Student's law.
/// The number of used samples must exceed the number of columns by more than two. nullopt if
/// numbers leave the range of a double nevertheless.
std::optional<OffsetEvidence> weigh_offsets(const OffsetModel& model);

}  // namespace palpate
