// Asserts that stated probabilities are true.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <iostream>
#include <string>

#include "tests/support/calibration.h"

namespace palpate::test {

/// Prints every bin and asserts those whose lower bound is at least `from` (1: none): the number of
/// right answers lies in the band of this coverage. A bin with few answers, whose band contains
/// every frequency, says nothing and cannot fail.
inline void expect_calibrated(const Calibration& calibration, const std::string& title, double from,
                              double coverage) {
  for (std::size_t b = 0; b < kProbabilityBins; ++b) {
    const Calibration::Bin& bin = calibration.bins()[b];
    const Band band = bin.band(coverage);
    if (band.least == 0 && band.most == bin.count()) {
      continue;
    }
    std::cout << "  " << title << " " << kProbabilityBounds[b] << " to "
              << kProbabilityBounds[b + 1] << ": stated " << bin.mean_stated() << ", right "
              << bin.right << " of " << bin.count() << ", band " << band.least << " to "
              << band.most << "\n";
    if (kProbabilityBounds[b] < from) {
      continue;  // printed only
    }
    EXPECT_GE(bin.right, band.least)
        << title << ", bin from " << kProbabilityBounds[b] << ": too sure";
    EXPECT_LE(bin.right, band.most)
        << title << ", bin from " << kProbabilityBounds[b] << ": not sure enough";
  }
}

}  // namespace palpate::test
