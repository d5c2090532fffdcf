// What another set-up's constant may be, from those of the recordings.
#include "core/qualification/setup_constants.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/qualification/qualify.h"
#include "tests/support/calibration.h"
#include "tests/support/probe_scene.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

SetupConstants drawn(int recordings, double between_m, double noise_m, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  SetupConstants constants;
  constants.value_m.resize(recordings);
  for (double& value : constants.value_m) {
    value = 1e-4 + std::hypot(between_m, noise_m) * normal(rng);
  }
  constants.covariance_m2 = noise_m * noise_m * Eigen::MatrixXd::Identity(recordings, recordings);
  return constants;
}

// One set-up says nothing of others: it is itself off by what is expected, and so is the next.
TEST(SetupConstants, OneRecordingLeavesWhatIsExpected) {
  SetupConstants constants;
  constants.value_m = Eigen::VectorXd::Constant(1, -3e-5);
  constants.covariance_m2 = Eigen::MatrixXd::Constant(1, 1, 1e-14);
  const SetupSpread spread = spread_of(constants, 5e-5);
  EXPECT_NEAR(spread.constant_m, -3e-5, 1e-12);
  EXPECT_NEAR(spread.elsewhere_m.value, std::sqrt(2.0) * 5e-5, 0.01 * 5e-5);
  EXPECT_GT(spread.elsewhere_m.deviation, 0.3 * spread.elsewhere_m.value);
}

TEST(SetupConstants, SetupsThatAgreeSaySo) {
  auto rng = test::test_rng();
  const SetupSpread spread = spread_of(drawn(8, 0.0, 1e-6, rng), 5e-5);
  EXPECT_LT(spread.elsewhere_m.value, 3e-6);
}

// Whatever had been expected, by 3 too much or too little.
TEST(SetupConstants, AnotherSetupLiesWithinWhatIsSaid) {
  auto rng = test::test_rng();
  std::normal_distribution<double> normal;
  constexpr double kBetween = 2e-5;
  constexpr double kNoise = 4e-6;
  constexpr int kRecordings = 6;
  const int runs = test::stress_count(400);
  for (const double expected : {kBetween / 3.0, kBetween, 3.0 * kBetween}) {
    int within = 0;
    for (int run = 0; run < runs; ++run) {
      const SetupSpread spread = spread_of(drawn(kRecordings, kBetween, kNoise, rng), expected);
      const double next = 1e-4 + kBetween * normal(rng);
      const double deviation =
          std::hypot(spread.elsewhere_m.value, kNoise / std::sqrt(kRecordings));
      within += std::abs(next - spread.constant_m) <= 2.5 * deviation ? 1 : 0;
    }
    const test::Band band =
        test::binomial_band(std::vector<double>(static_cast<std::size_t>(runs), 0.95), 1.0 - 2e-4);
    EXPECT_GE(within, band.least) << "expected " << expected << " in " << runs << " runs";
  }
}

TEST(SetupConstants, AreNotTakenForDrift) {
  auto rng = test::test_rng();
  test::ProbeScene scene;
  scene.probe = test::lobed_probe();
  const double constant = scene.probe.offset.coefficients_m[0];
  std::vector<ArtefactRecording> recordings;
  for (const double other : {4e-5, -3e-5, 0.0, 2e-5, -5e-5}) {
    scene.probe.offset.coefficients_m[0] = constant + other;
    recordings.push_back(simulate(scene, rng));
  }
  const Qualification result = qualify(scene.curve, recordings);
  ASSERT_EQ(result.status, QualificationStatus::Sufficient);
  const ProbeCharacter& probe = result.probe;
  EXPECT_NEAR(probe.deviation_m.value, scene.probe.deviation_m.value,
              4.0 * probe.deviation_m.deviation);
  EXPECT_NEAR(probe.sigma_m.value, scene.probe.sigma_m.value, 4.0 * probe.sigma_m.deviation);
  // The five differ by 3.6e-5 from their mean, which the constant is, but for a quarter of the
  // noise of each.
  EXPECT_NEAR(probe.offset.coefficients_m[0], constant - 4e-6, 2e-6);
  EXPECT_GT(probe.setup_m.value, 2.5e-5);
  EXPECT_LT(probe.setup_m.value, 8e-5);
  QualificationOptions same;
  same.same_setup = true;
  const Qualification alike = qualify(scene.curve, recordings, same);
  EXPECT_GT(alike.probe.deviation_m.value, 2.0 * scene.probe.deviation_m.value);
  EXPECT_EQ(alike.probe.setup_m.value, 0.0);
}

}  // namespace
}  // namespace palpate
