// Checks whether stated probabilities are true: counts in bins, compared with the exact confidence
// band.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace palpate::test {

/// Bounds of the bins of a stated probability. The first bin contains all below 0.5.
inline constexpr std::array kProbabilityBounds = {0.0, 0.5, 0.6, 0.8, 0.95, 0.99, 0.999, 1.0};
inline constexpr std::size_t kProbabilityBins = kProbabilityBounds.size() - 1;

std::size_t probability_bin(double probability);

/// The range that contains the number of successes of independent trials with these probabilities,
/// except for a probability of at most half of 1 - coverage on either side. Uses the exact law
/// (Poisson binomial).
struct Band {
  int least = 0;
  int most = 0;
};
Band binomial_band(const std::vector<double>& probabilities, double coverage);

/// Counts answers by their stated probability of being right.
class Calibration {
 public:
  void add(double probability, bool right);

  struct Bin {
    std::vector<double> stated;
    int right = 0;
    int count() const { return static_cast<int>(stated.size()); }
    double mean_stated() const;
    Band band(double coverage) const { return binomial_band(stated, coverage); }
  };
  const std::array<Bin, kProbabilityBins>& bins() const { return bins_; }

 private:
  std::array<Bin, kProbabilityBins> bins_;
};

}  // namespace palpate::test
