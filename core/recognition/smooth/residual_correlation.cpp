#include "core/recognition/smooth/residual_correlation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/probability/negligible.h"
#include "core/numerics/probability/normal_law.h"

namespace palpate {
namespace {

NeighbourSums sums_of(std::span<const RunOfResiduals> runs) {
  NeighbourSums sums;
  for (const auto& [r, parameters] : runs) {
    for (std::size_t i = 0; i < r.size(); ++i) {
      i == 0 ? sums.add_first(r[i], parameters) : sums.add_next(r[i]);
    }
  }
  return sums;
}

/// Mean product of residuals so many samples apart; 0 if there are none.
double mean_product(std::span<const RunOfResiduals> runs, std::size_t lag) {
  double sum = 0.0;
  std::size_t pairs = 0;
  for (const auto& [r, parameters] : runs) {
    for (std::size_t i = 0; i + lag < r.size(); ++i) {
      sum += r[i] * r[i + lag];
      ++pairs;
    }
  }
  return pairs > 0 ? sum / static_cast<double>(pairs) : 0.0;
}

}  // namespace

void NeighbourSums::add_first(double residual, std::size_t coefficients) {
  squares += residual * residual;
  ++samples;
  parameters += coefficients;
  last = residual;
}

void NeighbourSums::add_next(double residual) {
  products += last * residual;
  ++pairs;
  add_first(residual, 0);
}

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
  const double taken = static_cast<double>(sums.parameters) / static_cast<double>(sums.samples);
  const double longest =
      taken > 0.0 ? std::max(0.5 / taken, 1.0) : std::numeric_limits<double>::infinity();
  const double square = mean_product(runs, 0);
  // While they are positive: beyond that there is only noise.
  std::size_t lag = 1;
  double sum = 0.0;
  double sum_of_squares = 0.0;
  for (double shown = 0.0; static_cast<double>(lag) <= longest; ++lag) {
    shown = mean_product(runs, lag) / square;
    if (!(shown > 0.0)) {
      break;
    }
    sum += shown;
    sum_of_squares += shown * shown;
  }
  // Of the noise's variance v, `taken` time v has gone from the mean square and from each product:
  //   time v = v + 2 sum (product + taken time v),   mean square = v - taken time v.
  const double lags = static_cast<double>(lag) - 1.0;
  const double left = 1.0 - 2.0 * taken * (lags - sum);
  const double time = left > 0.0 ? std::min((1.0 + 2.0 * sum) / left, longest) : longest;
  // Noise that swings, as of a probe that shakes, averages out sooner: with its first way back, if
  // that is more than chance (M. S. Bartlett's variance of a correlation, 1946).
  const double back = std::min(taken * time, 0.5);
  double swing = 0.0;
  double deepest = 0.0;
  for (; static_cast<double>(lag) <= 2.0 * longest; ++lag) {
    const double shown = (1.0 - back) * mean_product(runs, lag) / square + back;
    if (!(shown < 0.0)) {
      break;
    }
    swing += shown;
    deepest = std::min(deepest, shown);
  }
  const double chance = std::sqrt((1.0 + 2.0 * sum_of_squares) / static_cast<double>(sums.samples));
  return deepest < -kNegligibleDeviations * chance ? std::max(1.0, time + 2.0 * swing) : time;
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
