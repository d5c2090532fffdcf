// The sliding window along strokes of 2 to 300 mm, of every class and of none, from the first
// window to the last: its published deviations must cover its errors, noise and bias together.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include "core/local/stream/sliding_window.h"
#include "tests/support/stroke.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr std::array kLengths_m = {0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.15, 0.3};
/// Relative to the size of the parts.
constexpr std::array kNoises = {0.0, 1e-5, 1e-4, 5e-4, 2e-3};
constexpr double kSize_m = 0.025;
/// Strokes of each kind; PALPATE_TEST_STRESS multiplies it.
int strokes() { return std::max(1, test::stress_count(2)); }
/// Windows checked along a stroke, including the first and the last; neighbours share samples.
constexpr std::size_t kWindows = 12;
/// Stated noise when the true noise is zero: the rounding of doubles at 0.2 m from the origin. [m]
constexpr double kRounding_m = 1e-16;

/// For kappa and kappa_s.
struct Tally {
  double count = 0.0;
  std::array<double, 2> within{};
  std::array<double, 2> gross{};
  std::array<double, 2> squares{};  ///< of those that are not gross

  void add(std::size_t k, double z) {
    constexpr double kGross = 4.0;
    within[k] += std::abs(z) <= 2.0 ? 1.0 : 0.0;
    gross[k] += std::abs(z) > kGross ? 1.0 : 0.0;
    squares[k] += std::abs(z) > kGross ? 0.0 : z * z;
  }
  double share(std::size_t k) const { return within[k] / count; }
  double gross_share(std::size_t k) const { return gross[k] / count; }
  double rms(std::size_t k) const { return std::sqrt(squares[k] / (count - gross[k])); }
  void print(const std::string& name) const {
    std::printf(
        "%-30s %6.0f   within 2: %5.1f %% %5.1f %%   beyond 4: %4.0f %4.0f   rms z: %5.2f %5.2f\n",
        name.c_str(), count, 100.0 * share(0), 100.0 * share(1), gross[0], gross[1], rms(0),
        rms(1));
  }
};

struct Tallies {
  Tally pooled;
  std::map<std::string, Tally> classes;
  std::map<std::string, Tally> cells;  ///< by class and length
};

Tallies walk(bool stated) {
  Tallies tallies;
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> normal;
  constexpr int kAll = 100;
  const int every =
      std::max(1, kAll / test::stress_count(kAll));  // of the strokes; fewer with a sanitizer
  int turn = 0;
  for (std::size_t shape = 0; shape < test::kStrokeShapes; ++shape) {
    for (const double length : kLengths_m) {
      for (const double noise : kNoises) {
        for (int i = 0; i < strokes(); ++i) {
          if (turn++ % every != 0) {
            continue;
          }
          const test::TrueStroke stroke = test::random_stroke(shape, length, rng);
          const double sigma = noise * kSize_m;
          SlidingWindow window({.sigma_m = stated ? std::max(sigma, kRounding_m) : 0.0});
          std::vector<LocalEstimate> estimates;
          for (const Vec2& exact : stroke.samples(test::usual_stride(stroke))) {
            const double x = normal(rng);
            const double y = normal(rng);
            const auto estimate = window.add(exact + sigma * Vec2(x, y));
            if (estimate && estimate->result) {
              estimates.push_back(estimate->result.estimate);
            }
          }
          const std::size_t step = std::max<std::size_t>(1, estimates.size() / kWindows);
          char cell[64];
          std::snprintf(cell, sizeof cell, "%s, %.0f mm", stroke.name.c_str(), 1e3 * length);
          for (std::size_t e = 0; e < estimates.size(); e += step) {
            const Eigen::Vector3d error = stroke.error_of(estimates[e]);
            for (Tally* tally :
                 {&tallies.pooled, &tallies.classes[stroke.name], &tallies.cells[cell]}) {
              // Rounding errors have a bound but no standard deviation that could be stated.
              if (noise == 0.0 && tally != &tallies.cells[cell]) {
                continue;
              }
              tally->count += 1.0;
              for (std::size_t k = 0; k < 2; ++k) {
                const auto row = static_cast<Eigen::Index>(k) + 2;
                tally->add(k, error[row - 1] / std::sqrt(estimates[e].covariance(row, row)));
              }
            }
          }
        }
      }
    }
  }
  return tallies;
}

class SlidingWindowCoverage : public testing::TestWithParam<bool> {};

INSTANTIATE_TEST_SUITE_P(Noise, SlidingWindowCoverage, testing::Bool(),
                         [](const auto& test) { return test.param ? "stated" : "estimated"; });

TEST_P(SlidingWindowCoverage, PublishedDeviationsHoldTheErrors) {
  const Tallies tallies = walk(GetParam());
  if (!test::counts_tell()) {
    return;
  }
  for (const auto& [name, tally] : tallies.cells) {
    tally.print(name);
    // 0.9 less what chance takes away with probability 1e-3. The windows of a stroke share samples
    // and, where it is estimated, the noise; they count as four.
    constexpr double kDeviations = 3.1;
    const double independent = 4.0 * strokes() * kNoises.size();
    const double least = 0.90 - kDeviations * std::sqrt(0.90 * 0.10 / independent);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_GE(tally.share(k), least) << name << (k == 0 ? " kappa" : " kappa_s");
    }
  }
  for (const auto& [name, tally] : tallies.classes) {
    tally.print(name);
    for (std::size_t k = 0; k < 2; ++k) {
      // Next to a cusp the curvature is unbounded, and no polynomial fits a window: a known limit.
      constexpr double kMostGross = 0.01;
      EXPECT_LE(tally.gross_share(k), kMostGross) << name << (k == 0 ? " kappa" : " kappa_s");
      EXPECT_LE(tally.rms(k), 1.1) << name << (k == 0 ? " kappa" : " kappa_s");
      // The coverage must not come from deviations that are too large.
      EXPECT_GE(tally.rms(k), 0.8) << name << (k == 0 ? " kappa" : " kappa_s");
    }
  }
  tallies.pooled.print("all");
  for (std::size_t k = 0; k < 2; ++k) {
    // 95 % in the limit of a normal distribution. The scatter of so many windows is below 2 %.
    EXPECT_NEAR(tallies.pooled.share(k), 0.95, 0.02) << (k == 0 ? "kappa" : "kappa_s");
  }
}

}  // namespace
}  // namespace palpate
