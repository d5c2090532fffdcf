#include "core/recognition/coherent/coherent_cells.h"

#include <algorithm>
#include <limits>

#include "core/numerics/matrices/small_cholesky.h"

namespace palpate {
namespace {

/// Expected offset for a drift, by the same law: a drift of length L corresponds to the harmonic of
/// order 1 / L (L in half extents). The constant alone is expected to be as large: the lobes
/// between would be seen, and it is not (core/README.md, "Deviations that neighbours share").
double expected_offset(const Drift& drift) {
  const double order = std::clamp(1.0 / drift.length, 2.0, static_cast<double>(kHighestOrder));
  return drift.deviation / overtone(static_cast<int>(std::lround(order)));
}

}  // namespace

bool can_tell_deviations(const FitData& reduced, const NoiseLaw& noise, int rank) {
  return static_cast<int>(reduced.points.size()) > rank && noise.degrees > 2.0 &&
         residual_count(reduced) == reduced.points.size();
}

double rounding_of_chi2(double squares) {
  constexpr double kOperations = 64.0;  // as many as round one after the other, or more
  return std::max(kOperations * std::numeric_limits<double>::epsilon() * squares,
                  std::numeric_limits<double>::min());
}

OffsetSize offset_size(const Drift& drift, int power) {
  const double ratio = std::ldexp(1.0, power);
  const double deviation = ratio * expected_offset(drift);
  OffsetSize size;
  // Student's density of a positive size, three degrees of freedom: flat near the expected size,
  // with a power-law tail.
  size.log_prior = std::log(ratio) - 2.0 * std::log1p(ratio * ratio / 3.0);
  size.deviations[0] = deviation;
  for (int k = 2; k <= kHighestOrder; ++k) {
    const int first = first_offset_of(k);
    size.deviations[first] = size.deviations[first + 1] = deviation * overtone(k);
  }
  return size;
}

template <int Highest>
std::optional<OffsetCells<Highest>> offset_cells(const LeftByDrift<Highest>& left,
                                                 const OffsetSize& size, const NoiseLaw& noise,
                                                 double scatter) {
  constexpr int kOffsets = offset_coefficients(Highest);
  const Offsets<Highest> deviations = size.deviations.template head<kOffsets>();
  OffsetMatrix<Highest> matrix =
      deviations.asDiagonal() * left.information * deviations.asDiagonal();
  matrix.diagonal().array() += 1.0;
  OffsetCells<Highest> cells;
  if (!cholesky(matrix, &cells.lower)) {
    return std::nullopt;
  }
  cells.told =
      solve_lower<kOffsets>(cells.lower, Offsets<Highest>(deviations.cwiseProduct(left.right)));
  double chi2 = scatter + left.chi2;
  double root_determinant = 1.0;
  for (int i = 0; i < kOffsets; ++i) {
    chi2 -= cells.told[i] * cells.told[i];
    root_determinant *= cells.lower(i, i);
    if (i % 2 == 1) {
      continue;  // a cosine without its sine
    }
    const auto order = static_cast<std::size_t>(i / 2);
    cells.chi2[order] = std::max(chi2, scatter + left.least_chi2);
    cells.log_weight[order] = size.log_prior + noise.log_evidence(cells.chi2[order]) -
                              0.5 * left.log_determinant - std::log(root_determinant);
  }
  return cells;
}

template std::optional<OffsetCells<kHighestOrder>> offset_cells(const LeftByDrift<kHighestOrder>&,
                                                                const OffsetSize&, const NoiseLaw&,
                                                                double);
template std::optional<OffsetCells<kHighestOfClasses>> offset_cells(
    const LeftByDrift<kHighestOfClasses>&, const OffsetSize&, const NoiseLaw&, double);

}  // namespace palpate
