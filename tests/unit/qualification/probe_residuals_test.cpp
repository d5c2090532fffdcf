// What a qualified probe may leave of a curve: the law of its residuals.
#include "core/qualification/probe_residuals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/numerics/probability/negligible.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// Strokes of samples a millimetre apart, with a probe of that deviation; 0 = without drift.
struct Strokes {
  ProbeCharacter probe;
  std::vector<ProbedPatch> patches;

  Strokes(double deviation_m, double length_m, double sigma_m) {
    probe.deviation_m.value = deviation_m;
    probe.deviation_length_m.value = length_m;
    for (int p = 0; p < 2; ++p) {
      ProbedPatch& patch = patches.emplace_back();
      patch.probe = &probe;
      for (int i = 0; i < 100; ++i) {
        patch.samples.push_back({{1e-3 * i, 0.1 * p}, sigma_m, 0});
      }
    }
  }
  Strokes(const Strokes&) = delete;
  Strokes& operator=(const Strokes&) = delete;
};

/// Chi-square, by the white noise, of residuals that the strokes draw: a Markov chain of a
/// deviation and white noise.
double drawn_chi2(const Strokes& strokes, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  const double deviation = strokes.probe.deviation_m.value;
  const double kept = std::exp(-1e-3 / strokes.probe.deviation_length_m.value);
  double chi2 = 0.0;
  for (const ProbedPatch& patch : strokes.patches) {
    double drift = deviation * normal(rng);
    for (const ContactSample& sample : patch.samples) {
      const double residual = drift / sample.sigma_m + normal(rng);
      chi2 += residual * residual;
      drift = kept * drift + std::sqrt(1.0 - kept * kept) * deviation * normal(rng);
    }
  }
  return chi2;
}

TEST(ProbeResiduals, WhiteNoiseAloneIsJudgedAsWithoutAFile) {
  const Strokes strokes(0.0, 0.01, 1e-5);
  EXPECT_EQ(most_chi2_of_probes(strokes.patches, 195), most_of_noise(195));
}

// A millionth of the residuals may exceed it. Those of a probe whose deviation is ten times as
// large, which a file that says otherwise would hide, do.
TEST(ProbeResiduals, NoneIsBeyondTheBoundAndALargerDeviationIs) {
  std::mt19937_64 rng = test::test_rng();
  for (const double length_m : {1e-3, 5e-3, 20e-3}) {
    for (const double deviation_m : {3e-6, 10e-6, 30e-6}) {
      const Strokes strokes(deviation_m, length_m, 1e-5);
      const double most = most_chi2_of_probes(strokes.patches, 200);
      for (int i = 0; i < test::stress_count(300); ++i) {
        EXPECT_LT(drawn_chi2(strokes, rng), most) << length_m << " " << deviation_m;
      }
    }
    const Strokes stated(3e-6, length_m, 1e-5);
    const Strokes actual(30e-6, length_m, 1e-5);
    EXPECT_GT(drawn_chi2(actual, rng), most_chi2_of_probes(stated.patches, 200)) << length_m;
  }
}

}  // namespace
}  // namespace palpate
