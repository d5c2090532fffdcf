// Whether residuals are white noise or neighbours err together, and how many of them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Sums over the residuals of neighbours, in units of their noise.
struct NeighbourSums {
  double squares = 0.0;
  double products = 0.0;  ///< of neighbours
  std::size_t samples = 0;
  std::size_t pairs = 0;
  std::size_t parameters = 0;  ///< coefficients fitted to them
  double last = 0.0;           ///< residual of the run that is being added

  /// Begins a run of neighbours, to which so many coefficients were fitted, with its first
  /// residual.
  void add_first(double residual, std::size_t coefficients);
  /// The next of them.
  void add_next(double residual);

  /// Whether neighbours are more alike than those of white noise are once in a thousand times. Each
  /// coefficient takes a variance of the noise from the products, as it does from the squares.
  bool look_alike() const;
};

/// The residuals of one run of neighbours, in order.
struct RunOfResiduals {
  std::vector<double> residuals;
  std::size_t parameters = 0;  ///< coefficients fitted to it
};

/// Of how many residuals each counts as one: the integrated autocorrelation time, 1 + 2 sum of the
/// correlations. 1 if neighbours do not look alike. Each fitted coefficient takes `time` variances
/// from the squares, and as much from the products; that is put back. Correlations too small to be
/// seen beside it are left out. At most half of the samples of a coefficient: slower deviations
/// look like the path. O(samples * time).
double correlation_time(std::span<const RunOfResiduals> runs);

/// Correlation along the arc, from form error of the part or drift of the probe: n such residuals
/// are worth n / time independent ones.
struct ResidualCorrelation {
  double time = 1.0;    ///< in samples; 1 = white
  double length = 0.0;  ///< arc length of the correlation, in units of the points; 0 = white
};

/// `residuals`: normalised, of all points, patch by patch in order.
ResidualCorrelation correlation_of(const FitData& data, std::span<const double> residuals);

}  // namespace palpate
