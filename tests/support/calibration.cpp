#include "tests/support/calibration.h"

#include <algorithm>
#include <numeric>

namespace palpate::test {

std::size_t probability_bin(double probability) {
  std::size_t bin = 0;
  while (bin + 1 < kProbabilityBins && probability >= kProbabilityBounds[bin + 1]) {
    ++bin;
  }
  return bin;
}

Band binomial_band(const std::vector<double>& probabilities, double coverage) {
  // The distribution of the number of successes, updated trial by trial.
  std::vector<double> law(probabilities.size() + 1, 0.0);
  law[0] = 1.0;
  std::size_t trials = 0;
  for (const double stated : probabilities) {
    const double p = std::clamp(stated, 0.0, 1.0);
    ++trials;
    for (std::size_t k = trials; k > 0; --k) {
      law[k] = law[k] * (1.0 - p) + law[k - 1] * p;
    }
    law[0] *= 1.0 - p;
  }
  const double tail = 0.5 * (1.0 - coverage);
  Band band{0, static_cast<int>(trials)};
  double below = law[0];
  while (band.least < band.most && below <= tail) {
    below += law[static_cast<std::size_t>(++band.least)];
  }
  double above = law[trials];
  while (band.most > band.least && above <= tail) {
    above += law[static_cast<std::size_t>(--band.most)];
  }
  return band;
}

void Calibration::add(double probability, bool right) {
  Bin& bin = bins_[probability_bin(probability)];
  bin.stated.push_back(probability);
  bin.right += right ? 1 : 0;
}

double Calibration::Bin::mean_stated() const {
  return stated.empty() ? 0.0
                        : std::accumulate(stated.begin(), stated.end(), 0.0) /
                              static_cast<double>(stated.size());
}

}  // namespace palpate::test
