// What one size of drift and offset makes of residuals: a cell of the integral over all sizes.
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
using Offsets = Eigen::Matrix<double, offsets_to(Highest), 1>;
template <int Highest>
using OffsetMatrix = Eigen::Matrix<double, offsets_to(Highest), offsets_to(Highest)>;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using UnknownsMatrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;

/// Lengths of drifts: from half of the longest run, beyond which they are a constant, by halves to
/// a thirty-second.
inline constexpr int kMostHalvings = 5;

/// Offsets over what is expected of them, as powers of 2: from where they are nothing beside the
/// drift to where Student's law has one in a thousand left.
inline constexpr int kLeastOffset = -3;
inline constexpr int kLargestOffset = 3;

/// Evidence by chi-square, and what variances count times: the noise is known or integrated out.
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

/// A sum of weights that come as logarithms, over the exponential of `top`.
struct LogSum {
  double top = -std::numeric_limits<double>::infinity();
  double total = 0.0;

  /// Whether anything of a weight would be seen beside those before.
  bool counts(double log_weight) const {
    constexpr double kNothing = 20.0;  // e^-20 of the highest, over some thousand cells
    return log_weight > top - kNothing;
  }
  struct Added {
    double before = 1.0;  ///< what all before are to be multiplied with
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

/// Whether so many points tell a variance; measured normals are beside this model.
bool can_tell_deviations(const FitData& reduced, const NoiseLaw& noise, int rank);

/// What a drift leaves of residuals once shape and pose have taken up what they can, linear in the
/// offset's coefficients c.
template <int Highest>
struct LeftByDrift {
  OffsetMatrix<Highest> information;  ///< of c
  Offsets<Highest> right;             ///< that times the best c
  double chi2 = 0.0;                  ///< without an offset
  double log_determinant = 0.0;
};

/// An offset by direction of one size.
struct OffsetSize {
  Offsets<kHighestOrder> deviations;  ///< prior standard deviation of each coefficient
  /// By its logarithm, of each highest order that it may have.
  double log_prior = 0.0;
};

/// 2^`power` times the offset that such a drift lets expect.
OffsetSize offset_size(const Drift& drift, int power);

/// All highest orders of one size: the leading rows of a triangular root are those of the lower
/// orders alone.
template <int Highest>
struct OffsetCells {
  OffsetMatrix<Highest> lower;
  Offsets<Highest> told;
  std::array<double, Highest> chi2{};        ///< as many orders: 0, 2, 3 ...
  std::array<double, Highest> log_weight{};  ///< of evidence and prior
};

/// `scatter`: chi-square beside that of the rows. nullopt where rounding leaves no root.
template <int Highest>
std::optional<OffsetCells<Highest>> offset_cells(const LeftByDrift<Highest>& left,
                                                 const OffsetSize& size, const NoiseLaw& noise,
                                                 double scatter);

}  // namespace palpate
