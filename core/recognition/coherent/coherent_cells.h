// One cell of the integral over all sizes of drift and offset: its evidence and what it leaves.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/recognition/coherent/coherent_rows.h"
#include "core/recognition/coherent/markov_drift.h"
#include "core/recognition/posterior/likelihood.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

template <int Highest>
using Offsets = Eigen::Matrix<double, offset_coefficients(Highest), 1>;
template <int Highest>
using OffsetMatrix =
    Eigen::Matrix<double, offset_coefficients(Highest), offset_coefficients(Highest)>;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using UnknownsMatrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;

/// A drift's size and length go by factors of 4 (every other power of 2): residuals show neither
/// more precisely.
inline constexpr int kPowerStep = 2;
inline constexpr double kSizeFactor = 1 << kPowerStep;

/// Drift lengths: half of the longest run (a longer drift is a constant) down to a thirty-second.
inline constexpr int kMostHalvings = 5;

/// Sizes of the offset relative to its expected size, as powers of 2: from negligible next to the
/// drift to where Student's law has four in a thousand left.
inline constexpr int kLeastOffset = -3;
inline constexpr int kLargestOffset = 3;

/// Evidence by chi-square, and the scale of variances, for noise that is known or integrated out.
struct NoiseLaw {
  NoiseLaw(const Likelihood& likelihood, int rank)
      : known(likelihood.sigma_known), degrees(likelihood.samples - rank) {}
  bool known;
  double degrees;
  double log_evidence(double chi2) const {
    return known ? -0.5 * chi2 : -0.5 * degrees * std::log(chi2);
  }
  double scale(double chi2) const { return known ? 1.0 : chi2 / (degrees - 2.0); }
};

/// Sum of weights given as logarithms, divided by exp(top).
struct LogSum {
  double top = -std::numeric_limits<double>::infinity();
  double total = 0.0;

  /// True if a weight is large enough to change the sum.
  bool counts(double log_weight) const {
    constexpr double kNothing = 20.0;  // e^-20 of the largest weight, over about a thousand cells
    return log_weight > top - kNothing;
  }
  struct Added {
    double before = 1.0;  ///< factor on the sums so far
    double weight = 0.0;
  };
  Added add(double log_weight) {
    Added added;
    if (log_weight > top) {
      added.before = std::exp(top - log_weight);
      top = log_weight;
    }
    added.weight = std::exp(log_weight - top);
    total = added.before * total + added.weight;
    return added;
  }
};

/// True if there are enough points to estimate a variance and no measured normals, which this model
/// does not cover.
bool can_tell_deviations(const FitData& reduced, const NoiseLaw& noise, int rank);

/// The residuals under a drift after shape and pose have been eliminated, as a function of the
/// offset's coefficients c.
template <int Highest>
struct LeftByDrift {
  OffsetMatrix<Highest> information;  ///< information of c
  Offsets<Highest> right;             ///< information times the best c
  double chi2 = 0.0;                  ///< without an offset; at least `least_chi2`
  double least_chi2 = 0.0;            ///< rounding_of_chi2
  double log_determinant = 0.0;
};

/// The least chi-square that a difference of sums of squares as large as `squares` can show.
double rounding_of_chi2(double squares);

/// The size of an offset by direction.
struct OffsetSize {
  Offsets<kHighestOrder> deviations;  ///< prior standard deviation of each coefficient
  /// Prior density by the logarithm of the size, the same for each highest order.
  double log_prior = 0.0;
};

/// 2^`power` times the offset that is expected for this drift.
OffsetSize offset_size(const Drift& drift, int power);

/// Results for all highest orders of one size. The leading rows of a triangular root are the root
/// for the lower orders alone.
template <int Highest>
struct OffsetCells {
  OffsetMatrix<Highest> lower;
  Offsets<Highest> told;
  std::array<double, Highest> chi2{};        ///< by highest order: 0, 2, 3 ...
  std::array<double, Highest> log_weight{};  ///< evidence times prior, by highest order
};

/// `scatter`: chi-square in addition to that of the rows. nullopt if rounding leaves no root.
template <int Highest>
std::optional<OffsetCells<Highest>> offset_cells(const LeftByDrift<Highest>& left,
                                                 const OffsetSize& size, const NoiseLaw& noise,
                                                 double scatter);

}  // namespace palpate
