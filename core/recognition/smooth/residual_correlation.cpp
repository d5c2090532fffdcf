#include "core/recognition/smooth/residual_correlation.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/normal_law.h"

namespace palpate {
namespace {

/// Correlation of residuals `lag` samples apart in the same patch, and the number of pairs.
struct LagCorrelation {
  double value = 0.0;
  std::size_t pairs = 0;
};

LagCorrelation at_lag(const FitData& data, std::span<const double> r, std::size_t lag,
                      double variance) {
  LagCorrelation correlation;
  double sum = 0.0;
  for (const PatchSpan& patch : data.patches) {
    for (std::size_t i = patch.begin; i + lag < patch.end; ++i) {
      sum += r[i] * r[i + lag];
      ++correlation.pairs;
    }
  }
  if (correlation.pairs > 0) {
    correlation.value = sum / (static_cast<double>(correlation.pairs) * variance);
  }
  return correlation;
}

}  // namespace

ResidualCorrelation correlation_of(const FitData& data, std::span<const double> residuals) {
  ResidualCorrelation result;
  double variance = 0.0;
  for (const double r : residuals) {
    variance += r * r;
  }
  variance /= std::max<double>(1.0, static_cast<double>(residuals.size()));
  if (!(variance > 0.0)) {
    return result;
  }
  // White residuals look correlated once in a thousand times: their sum is about normal.
  static const double kOneInThousand = two_sided_normal_quantile(2.0 / 1000.0);
  const LagCorrelation first = at_lag(data, residuals, 1, variance);
  if (first.pairs == 0 ||
      first.value * std::sqrt(static_cast<double>(first.pairs)) < kOneInThousand) {
    return result;
  }
  // Sums while positive (the initial positive sequence); beyond that there is only noise.
  std::size_t longest = 0;
  double arc = 0.0;
  std::size_t steps = 0;
  for (const PatchSpan& patch : data.patches) {
    longest = std::max(longest, patch.size());
    for (std::size_t i = patch.begin + 1; i < patch.end; ++i) {
      arc += (data.points[i].position - data.points[i - 1].position).norm();
      ++steps;
    }
  }
  double sum = first.value;
  for (std::size_t lag = 2; lag < longest; ++lag) {
    const LagCorrelation correlation = at_lag(data, residuals, lag, variance);
    if (correlation.pairs == 0 || correlation.value <= 0.0) {
      break;
    }
    sum += correlation.value;
  }
  result.time = 1.0 + 2.0 * sum;
  result.length = steps > 0 ? result.time * arc / static_cast<double>(steps) : 0.0;
  return result;
}

}  // namespace palpate
