// Qualification on simulated strokes: what it says is within what it says of it, and where it
// cannot say a thing it says that.
#include "core/qualification/qualify.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "tests/support/calibration.h"
#include "tests/support/probe_scene.h"
#include "tests/support/qualified_terms.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

using test::ProbeScene;
using test::simulate;

Qualification qualified(const ProbeScene& scene, std::mt19937_64& rng) {
  const std::vector<ArtefactRecording> recordings = {simulate(scene, rng)};
  return qualify(scene.curve, recordings);
}

/// A probe of white noise alone.
ProbeCharacter plain_probe(double sigma_m) {
  ProbeCharacter probe;
  probe.sigma_m.value = sigma_m;
  probe.deviation_length_m.value = 1.0;
  return probe;
}

TEST(Qualify, EveryTermLiesWithinItsDeviations) {
  auto rng = test::test_rng();
  ProbeScene scene;
  scene.probe = test::lobed_probe();
  const int runs = test::stress_count(40);
  std::map<std::string, int> within;
  for (int run = 0; run < runs; ++run) {
    const Qualification result = qualified(scene, rng);
    ASSERT_EQ(result.status, QualificationStatus::Sufficient);
    ASSERT_TRUE(result.probe.lag_m.has_value());
    for (const test::QualifiedTerm& term : test::qualified_terms(scene.probe, result.probe)) {
      within[term.name] += std::abs(term.deviations()) <= 2.5 ? 1 : 0;
    }
  }
  // A count that 95 % would fall below by a chance of one in ten thousand.
  const test::Band band =
      test::binomial_band(std::vector<double>(static_cast<std::size_t>(runs), 0.95), 1.0 - 2e-4);
  EXPECT_EQ(within.size(), 10U);
  for (const auto& [name, count] : within) {
    EXPECT_GE(count, band.least) << name << " in " << runs << " runs";
  }
}

TEST(Qualify, WithoutNoiseFindsTheOffsetItself) {
  auto rng = test::test_rng();
  ProbeScene scene;
  scene.probe = plain_probe(1e-9);
  scene.probe.offset.order = 2;
  scene.probe.offset.coefficients_m = Eigen::Vector3d(-2e-5, 3e-5, 1e-5);
  const Qualification result = qualified(scene, rng);
  ASSERT_EQ(result.probe.offset.order, 2);
  // A lobe turns the surface that the tip's centres follow: second order, 3e-5 squared times 2^2
  // over the radius.
  const double second_order = 4.0 * 3e-5 * 3e-5 / 0.027;
  for (Eigen::Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(result.probe.offset.coefficients_m[i], scene.probe.offset.coefficients_m[i],
                second_order);
  }
}

TEST(Qualify, AFirstHarmonicIsAShiftOfTheFrame) {
  auto rng = test::test_rng();
  ProbeScene scene;
  scene.probe = plain_probe(1e-6);
  ArtefactRecording recording = simulate(scene, rng);
  const Qualification before = qualify(scene.curve, {{recording}});
  for (ArtefactStroke& stroke : recording.strokes) {
    for (ContactSample& sample : stroke.samples) {
      const Vec2 out = (sample.position_m - scene.world_T_curve.translation()).normalized();
      sample.position_m += 5e-5 * out.x() * out;
    }
  }
  const Qualification after = qualify(scene.curve, {{recording}});
  EXPECT_NEAR(after.poses[0].x - before.poses[0].x, 5e-5, 1e-6);
  EXPECT_NEAR(after.probe.offset.coefficients_m[0], before.probe.offset.coefficients_m[0], 1e-6);
}

TEST(Qualify, SeveralRecordingsHaveTheirOwnPoses) {
  auto rng = test::test_rng();
  ProbeScene scene;
  scene.curve = Ellipse{0.03, 0.02};
  scene.probe = test::lobed_probe();
  scene.probe.lag_m.reset();
  ArtefactRecording one = simulate(scene, rng);
  scene.world_T_curve = {-0.2, 0.4, 0.3 + 0.25 * kPi};
  ArtefactRecording other = simulate(scene, rng);
  const Qualification alone = qualify(scene.curve, {{one}});
  const Qualification both = qualify(scene.curve, std::vector<ArtefactRecording>{one, other});
  ASSERT_EQ(both.poses.size(), 2U);
  EXPECT_NEAR(std::remainder(both.poses[1].theta - scene.world_T_curve.theta, kPi), 0.0, 1e-2);
  // An ellipse takes two lobes between its axes for its own turn; turned by half a right angle, it
  // takes those along its axes.
  EXPECT_LT(both.worst_offset_deviation_m, 0.5 * alone.worst_offset_deviation_m);
  EXPECT_EQ(both.status, QualificationStatus::Sufficient);
}

TEST(Qualify, SaysWhatWasNotTouched) {
  auto rng = test::test_rng();
  ProbeScene scene;
  scene.probe = test::lobed_probe();
  scene.arc_t = 1.5 * kPi;
  const Qualification most = qualified(scene, rng);
  ASSERT_EQ(most.untouched.size(), 1U);
  EXPECT_NEAR(most.untouched[0].second - most.untouched[0].first, 0.5 * kPi, 0.1);
  EXPECT_NE(most.status, QualificationStatus::Sufficient);
  scene.arc_t = 0.5;
  EXPECT_EQ(qualified(scene, rng).status, QualificationStatus::Insufficient);
}

// Half a ring bends as much by two lobes as by three and another constant: where the samples alone
// ask for no third, an offset that is certain is wrong.
TEST(Qualify, HalfARingTellsNoOffsetThatAnotherLobeWouldMove) {
  auto rng = test::test_rng();
  ProbeScene scene;
  scene.probe = plain_probe(5e-6);
  scene.probe.offset.order = 3;
  scene.probe.offset.coefficients_m.resize(5);
  scene.probe.offset.coefficients_m << -3e-5, 4e-5, -2e-5, 0.0, 1.5e-5;
  scene.arc_t = kPi;
  scene.samples = 150;
  scene.world_T_curve = {0.1, -0.05, 0.0};
  QualificationOptions one_setup;
  one_setup.same_setup = true;
  const int rings = test::stress_count(60);
  for (int ring = 0; ring < rings; ++ring) {
    const std::vector<ArtefactRecording> recordings = {simulate(scene, rng)};
    const Qualification result = qualify(scene.curve, recordings, one_setup);
    const NormalOffset& offset = result.probe.offset;
    // A normal law has more than six of its deviations once in 500 million times.
    EXPECT_TRUE(result.status == QualificationStatus::Insufficient ||
                std::abs(offset.coefficients_m[0] - scene.probe.offset.coefficients_m[0]) <=
                    6.0 * std::sqrt(offset.covariance_m2(0, 0)))
        << ring << ": order " << offset.order << ", offset " << offset.coefficients_m[0] << " +- "
        << std::sqrt(offset.covariance_m2(0, 0));
  }
}

TEST(Qualify, AnOffsetOfATenthOfTheTipIsRatherAnotherSize) {
  auto rng = test::test_rng();
  ProbeScene scene;
  scene.probe = plain_probe(1e-6);
  for (const double off : {-0.11, -0.09, 0.09, 0.11}) {
    scene.probe.offset.coefficients_m[0] = off * scene.tip_radius_m;
    const Qualification result = qualified(scene, rng);
    EXPECT_EQ(result.rather_another_size, std::abs(off) > 0.1) << off;
    EXPECT_EQ(result.status, std::abs(off) > 0.1 ? QualificationStatus::Insufficient
                                                 : QualificationStatus::Sufficient)
        << off;
  }
}

TEST(Qualify, OneWayTellsNoLag) {
  auto rng = test::test_rng();
  ProbeScene scene;
  scene.probe = test::lobed_probe();
  scene.strokes = 1;
  scene.samples = 600;
  const Qualification result = qualified(scene, rng);
  EXPECT_FALSE(result.both_directions);
  EXPECT_FALSE(result.probe.lag_m.has_value());
}

TEST(Qualify, TipsTellABore) {
  auto rng = test::test_rng();
  ProbeScene scene;
  scene.probe = plain_probe(1e-6);
  scene.tip_radius_m = 0.0;
  ArtefactRecording recording = simulate(scene, rng);
  for (ArtefactStroke& stroke : recording.strokes) {
    stroke.tip_radius_m = 2e-3;
    for (ContactSample& sample : stroke.samples) {
      const Vec2 centre = scene.world_T_curve.translation();
      sample.position_m -= 2.01e-3 * (sample.position_m - centre).normalized();
    }
  }
  const Qualification result = qualify(scene.curve, {{recording}});
  EXPECT_TRUE(result.bore);
  EXPECT_NEAR(result.probe.offset.coefficients_m[0], 1e-5, 1e-6);
}

TEST(Qualify, LoneTouchesDo) {
  auto rng = test::test_rng();
  ProbeScene scene;
  scene.probe = plain_probe(5e-6);
  scene.probe.offset.coefficients_m[0] = -2e-5;
  scene.samples = 40;
  ArtefactRecording touches;
  for (const ArtefactStroke& stroke : simulate(scene, rng).strokes) {
    for (const ContactSample& sample : stroke.samples) {
      touches.strokes.push_back({{sample}, stroke.tip_radius_m});
    }
  }
  const Qualification result = qualify(scene.curve, {{touches}});
  ASSERT_EQ(result.status, QualificationStatus::Sufficient);
  const double deviation = std::sqrt(result.probe.offset.covariance_m2(0, 0));
  EXPECT_NEAR(result.probe.offset.coefficients_m[0], -2e-5, 4.0 * deviation);
  EXPECT_FALSE(result.both_directions);
}

TEST(Qualify, RefusesWhatIsNone) {
  auto rng = test::test_rng();
  ProbeScene scene;
  scene.probe = plain_probe(1e-6);
  ArtefactRecording recording = simulate(scene, rng);
  EXPECT_EQ(qualify(Line{}, {{recording}}).status, QualificationStatus::BadArtefact);
  EXPECT_EQ(qualify(scene.curve, {}).status, QualificationStatus::TooFewSamples);
  ArtefactRecording few = recording;
  few.strokes.resize(1);
  few.strokes[0].samples.resize(5);
  EXPECT_EQ(qualify(scene.curve, {{few}}).status, QualificationStatus::TooFewSamples);
  ArtefactRecording several = recording;
  several.strokes.push_back(several.strokes.back());
  several.strokes.back().tip_radius_m += 1e-3;
  EXPECT_EQ(qualify(scene.curve, {{several}}).status, QualificationStatus::SeveralTips);
  EXPECT_EQ(qualify(scene.curve, {{recording, several}}).status, QualificationStatus::SeveralTips);
  ArtefactRecording bad = recording;
  bad.strokes[0].samples[3].position_m.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(qualify(scene.curve, {{bad}}).status, QualificationStatus::NotFinite);
  ArtefactRecording still = recording;
  for (ArtefactStroke& stroke : still.strokes) {
    for (ContactSample& sample : stroke.samples) sample.position_m = Vec2(0.1, 0.1);
  }
  EXPECT_EQ(qualify(scene.curve, {{still}}).status, QualificationStatus::NotTheArtefact);
}

TEST(Qualify, SamplesWithoutAnyNoiseAreTakenAtTheirWord) {
  ArtefactRecording recording;
  ArtefactStroke& stroke = recording.strokes.emplace_back();
  for (int i = 0; i < 200; ++i) {
    const double t = 2.0 * kPi * i / 200;
    stroke.samples.push_back({Vec2(0.02501 * std::cos(t), 0.02501 * std::sin(t)), 0.0, 0});
  }
  const Qualification result = qualify(Circle{0.025}, {{recording}});
  EXPECT_NEAR(result.probe.offset.coefficients_m[0], 1e-5, 1e-12);
  EXPECT_LT(result.probe.sigma_m.value, 1e-12);
  for (const QualifiedSample& sample : result.samples) EXPECT_FALSE(sample.spike);
}

TEST(Qualify, AnotherArtefactIsNotTakenForThis) {
  auto rng = test::test_rng();
  ProbeScene scene;
  scene.probe = plain_probe(1e-5);
  const ArtefactRecording recording = simulate(scene, rng);
  EXPECT_EQ(qualify(Circle{0.05}, {{recording}}).status, QualificationStatus::NotTheArtefact);
  EXPECT_EQ(qualify(Circle{25.0}, {{recording}}).status, QualificationStatus::NotTheArtefact);
  ProbeScene oval;
  oval.curve = Ellipse{0.026, 0.024};
  oval.probe = plain_probe(1e-5);
  EXPECT_EQ(qualify(Circle{0.025}, {{simulate(oval, rng)}}).status,
            QualificationStatus::NotTheArtefact);
  ArtefactRecording cloud;
  std::normal_distribution<double> normal;
  cloud.strokes.emplace_back();
  for (int i = 0; i < 200; ++i) {
    cloud.strokes[0].samples.push_back({Vec2(normal(rng), normal(rng)), 0.0, 0});
  }
  EXPECT_EQ(qualify(Circle{0.025}, {{cloud}}).status, QualificationStatus::NotTheArtefact);
}

}  // namespace
}  // namespace palpate
