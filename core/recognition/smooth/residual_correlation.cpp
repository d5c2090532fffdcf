#include "core/recognition/smooth/residual_correlation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/numerics/normal_law.h"

namespace palpate {
namespace {

NeighbourSums sums_of(std::span<const RunOfResiduals> runs) {
  NeighbourSums sums;
  for (const auto& [r, parameters] : runs) {
    for (std::size_t i = 0; i < r.size(); ++i) {
      sums.squares += r[i] * r[i];
      sums.products += i > 0 ? r[i] * r[i - 1] : 0.0;
    }
    sums.samples += r.size();
    sums.pairs += r.empty() ? 0 : r.size() - 1;
    sums.parameters += parameters;
  }
  return sums;
}

/// Mean products of residuals by the number of samples between them, while they are positive:
/// beyond that there is only noise.
std::vector<double> mean_products(std::span<const RunOfResiduals> runs, double most_lags) {
  std::vector<double> means;
  while (static_cast<double>(means.size()) <= most_lags) {
    const std::size_t lag = means.size();
    double sum = 0.0;
    std::size_t pairs = 0;
    for (const auto& [r, parameters] : runs) {
      for (std::size_t i = 0; i + lag < r.size(); ++i) {
        sum += r[i] * r[i + lag];
        ++pairs;
      }
    }
    if (!(sum > 0.0)) {
      break;
    }
    means.push_back(sum / static_cast<double>(pairs));
  }
  return means;
}

}  // namespace

bool NeighbourSums::look_alike() const {
  static const double kOneInThousand = two_sided_normal_quantile(2.0 / 1000.0);
  if (pairs == 0 || samples <= parameters) {
    return false;
  }
  const auto left = static_cast<double>(samples - parameters);
  const double variance = squares / left;
  const double of_noise = products + static_cast<double>(parameters) * variance;
  // The sum of as many products of independent residuals is about normal.
  return of_noise >
         kOneInThousand * std::sqrt(std::min(left, static_cast<double>(pairs))) * variance;
}

double correlation_time(std::span<const RunOfResiduals> runs) {
  const NeighbourSums sums = sums_of(runs);
  if (!sums.look_alike()) {
    return 1.0;
  }
  // Of the noise's variance v, `taken` time v has gone from the mean square and from each product:
  //   time v = v + 2 sum (product + taken time v),   mean square = v - taken time v.
  const double taken = static_cast<double>(sums.parameters) / static_cast<double>(sums.samples);
  const double longest =
      taken > 0.0 ? std::max(0.5 / taken, 1.0) : std::numeric_limits<double>::infinity();
  const std::vector<double> shown = mean_products(runs, longest);
  const double lags = static_cast<double>(shown.size()) - 1.0;
  const double sum = std::accumulate(shown.begin() + 1, shown.end(), 0.0) / shown.front();
  const double left = 1.0 - 2.0 * taken * (lags - sum);
  return left > 0.0 ? std::min((1.0 + 2.0 * sum) / left, longest) : longest;
}

ResidualCorrelation correlation_of(const FitData& data, std::span<const double> residuals) {
  std::vector<RunOfResiduals> runs;
  for (const PatchSpan& patch : data.patches) {
    const auto of_patch = residuals.subspan(patch.begin, patch.size());
    runs.push_back({{of_patch.begin(), of_patch.end()}, 0});
  }
  const double time = correlation_time(runs);
  return time > 1.0 ? ResidualCorrelation{time, time * mean_step(data)} : ResidualCorrelation{};
}

}  // namespace palpate
