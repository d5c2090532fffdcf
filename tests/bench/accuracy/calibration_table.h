// A table of stated probabilities and how often they are true, one row per bin.
#pragma once

#include <cstdio>
#include <string>

#include "tests/support/calibration.h"

namespace palpate::bench {

/// Prints the table. Returns how many bins are outside the binomial band that contains them in 99.9
/// % of runs.
inline int print_calibration(const std::string& title, const test::Calibration& calibration) {
  constexpr double kCoverage = 0.999;
  int beside = 0;
  bool first = true;
  for (std::size_t b = 0; b < test::kProbabilityBins; ++b) {
    const auto& bin = calibration.bins()[b];
    if (bin.count() == 0) continue;
    const test::Band band = bin.band(kCoverage);
    const bool within = bin.right >= band.least && bin.right <= band.most;
    beside += within ? 0 : 1;
    const double n = bin.count();
    std::printf("%-24s %5.3f-%-5.3f %7d %9.4f %9.4f   %.4f-%.4f %s\n", first ? title.c_str() : "",
                test::kProbabilityBounds[b], test::kProbabilityBounds[b + 1], bin.count(),
                bin.mean_stated(), bin.right / n, band.least / n, band.most / n,
                within ? "" : "BESIDE");
    first = false;
  }
  return beside;
}

}  // namespace palpate::bench
