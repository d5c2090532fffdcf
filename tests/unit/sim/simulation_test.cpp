// The simulator's contacts: repeatable, spaced as asked, noisy as asked, and errors that name the
// field.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "sim/contacts.h"
#include "sim/scene_file.h"
#include "sim/truth.h"

namespace palpate {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

sim::Scene scene_of(const std::string& text) {
  Result<sim::Scene> scene = sim::parse_scene(text, "scene.textproto");
  EXPECT_TRUE(scene.value.has_value()) << scene.error;
  return std::move(*scene.value);
}

constexpr const char* kCircle =
    "seed: 5\n"
    "curve { curve_class: CURVE_CLASS_CIRCLE parameters { a: 0.02 } }\n"
    "pose { x_m: 0.1 y_m: 0.2 }\n";

std::string probe(const std::string& noise, const std::string& patch) {
  return std::string(kCircle) + "noise { " + noise + " }\nprobes { name: \"p\" patches { " + patch +
         " } }\n";
}

TEST(Simulation, TheSameSeedGivesTheSameSamplesAndAnotherRoundOthers) {
  const sim::Scene scene =
      scene_of(probe("sigma_m: 1e-5", "start_t: 0 arc_m: 0.02 spacing_m: 2e-4"));
  const auto one = sim::simulate_contacts(scene, 0);
  const auto two = sim::simulate_contacts(scene, 0);
  const auto other = sim::simulate_contacts(scene, 1);
  ASSERT_EQ(one[0].patches[0].samples.size(), 101U);
  for (std::size_t i = 0; i < 101; ++i) {
    EXPECT_EQ(one[0].patches[0].samples[i].position_m, two[0].patches[0].samples[i].position_m);
    EXPECT_NE(one[0].patches[0].samples[i].position_m, other[0].patches[0].samples[i].position_m);
  }
}

TEST(Simulation, SamplesLieOnTheCurveAtTheSpacingAsked) {
  const sim::Scene scene =
      scene_of(probe("", "start_t: 1 arc_m: 0.02 spacing_m: 2e-4 backwards: true"));
  const auto probes = sim::simulate_contacts(scene, 0);
  const auto& samples = probes[0].patches[0].samples;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec2 from = samples[i].position_m - Vec2(0.1, 0.2);
    EXPECT_NEAR(from.norm(), 0.02, 1e-15);
    const double t = 1.0 - 2e-4 / 0.02 * static_cast<double>(i);
    EXPECT_NEAR(std::atan2(from.y(), from.x()), t, 1e-12);
  }
}

TEST(Simulation, NoiseHasTheStandardDeviationAsked) {
  constexpr double kSigma = 1e-5;
  const sim::Scene scene =
      scene_of(probe("sigma_m: 1e-5", "start_t: 0 arc_m: 0.1 spacing_m: 1e-5"));
  const auto probes = sim::simulate_contacts(scene, 0);
  const auto& samples = probes[0].patches[0].samples;
  double squares = 0.0;
  for (const auto& sample : samples) {
    const double off = (sample.position_m - Vec2(0.1, 0.2)).norm() - 0.02;
    squares += off * off;
  }
  // Relative standard deviation of a variance: sqrt(2 / n); four of them.
  const double n = static_cast<double>(samples.size());
  EXPECT_NEAR(squares / n / (kSigma * kSigma), 1.0, 4.0 * std::sqrt(2.0 / n));
  EXPECT_EQ(samples.front().sigma_m, kSigma);
}

TEST(Simulation, NormalsGoOutWithTheDeviationAskedAndChangeNothingElse) {
  const std::string patch = "start_t: 0 arc_m: 0.1 spacing_m: 1e-5";
  const auto plain = sim::simulate_contacts(scene_of(probe("sigma_m: 1e-5", patch)), 0);
  const auto told =
      sim::simulate_contacts(scene_of(probe("sigma_m: 1e-5 normal_sigma_rad: 0.02", patch)), 0);
  double squares = 0.0;
  const auto& samples = told[0].patches[0].samples;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].position_m, plain[0].patches[0].samples[i].position_m);
    EXPECT_FALSE(says_more(plain[0].patches[0].samples[i].detail));
    EXPECT_TRUE(is_sound(samples[i].detail));
    EXPECT_EQ(samples[i].detail.normal_sigma_rad, 0.02);
    const Vec2 normal = samples[i].detail.normal;
    const Vec2 outward(std::cos(samples[i].t), std::sin(samples[i].t));
    const double off = std::atan2(cross(outward, normal), outward.dot(normal));
    squares += off * off;
  }
  const double n = static_cast<double>(samples.size());
  EXPECT_NEAR(squares / (n * 0.02 * 0.02), 1.0, 4.0 * std::sqrt(2.0 / n));
}

TEST(Simulation, NoiseHasTheCovarianceAsked) {
  const Eigen::Vector3d asked(9e-10, -4e-10, 4e-10);
  const auto probes =
      sim::simulate_contacts(scene_of(probe("cov_xx_m2: 9e-10 cov_xy_m2: -4e-10 cov_yy_m2: 4e-10",
                                            "start_t: 0 arc_m: 0.1 spacing_m: 1e-5")),
                             0);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const auto& samples = probes[0].patches[0].samples;
  for (const auto& sample : samples) {
    const Vec2 on_curve = Vec2(0.1, 0.2) + 0.02 * Vec2(std::cos(sample.t), std::sin(sample.t));
    const Vec2 off = sample.position_m - on_curve;
    sum += Eigen::Vector3d(off.x() * off.x(), off.x() * off.y(), off.y() * off.y());
    EXPECT_EQ(sample.detail.covariance_m2, asked);
    EXPECT_EQ(sample.sigma_m, mean_sigma_m(asked));
  }
  const double n = static_cast<double>(samples.size());
  // Standard deviation of a mean product: sqrt((xx yy + xy^2) / n); four of them.
  EXPECT_NEAR(sum[0] / n, asked[0], 4.0 * asked[0] * std::sqrt(2.0 / n));
  EXPECT_NEAR(sum[1] / n, asked[1], 4.0 * std::sqrt((36e-20 + 16e-20) / n));
  EXPECT_NEAR(sum[2] / n, asked[2], 4.0 * asked[2] * std::sqrt(2.0 / n));
}

TEST(Simulation, ACovarianceThatIsNoneIsNamed) {
  for (const char* noise :
       {"cov_xx_m2: 1e-10", "cov_xx_m2: 1e-10 cov_xy_m2: 2e-10 cov_yy_m2: 1e-10",
        "sigma_m: 1e-5 cov_xx_m2: 1e-10 cov_yy_m2: 1e-10", "normal_sigma_rad: -0.1",
        "normal_sigma_rad: 4"}) {
    const auto scene =
        sim::parse_scene(probe(noise, "start_t: 0 arc_m: 0.1 spacing_m: 1e-3"), "scene.textproto");
    EXPECT_FALSE(scene.value.has_value()) << noise;
    EXPECT_THAT(scene.error, HasSubstr("scene.textproto:4: noise."));
  }
}

TEST(Simulation, SpikesAndDropoutsComeAtTheirRates) {
  const sim::Scene scene =
      scene_of(probe("sigma_m: 1e-7 spike_probability: 0.1 spike_m: 0.001 dropout_probability: 0.2 "
                     "hide_sigma: true",
                     "start_t: 0 arc_m: 0.1 spacing_m: 1e-5"));
  const auto probes = sim::simulate_contacts(scene, 0);
  const auto& samples = probes[0].patches[0].samples;
  const double asked = 10001.0;
  const double n = static_cast<double>(samples.size());
  EXPECT_NEAR(n / asked, 0.8, 4.0 * std::sqrt(0.8 * 0.2 / asked));
  double spikes = 0.0;
  for (const auto& sample : samples) {
    // A spike along the tangent stays near the circle: those farther than a tenth of its size
    // count.
    spikes += std::abs((sample.position_m - Vec2(0.1, 0.2)).norm() - 0.02) > 1e-4 ? 1.0 : 0.0;
    EXPECT_EQ(sample.sigma_m, 0.0);
  }
  // |sin| < about 0.1 of all directions: between 85 % and all of the spikes are seen.
  EXPECT_GT(spikes / n, 0.085 - 4.0 * std::sqrt(0.09 / n));
  EXPECT_LT(spikes / n, 0.1 + 4.0 * std::sqrt(0.09 / n));
}

TEST(Simulation, ARoundTipRunsOnTheOffsetOutsideTheMaterial) {
  const sim::Scene scene = scene_of(std::string(kCircle) +
                                    "probes { name: \"p\" tip_radius_m: 0.003 patches { start_t: 0 "
                                    "arc_m: 0.02 spacing_m: 2e-4 } }\n");
  const auto probes = sim::simulate_contacts(scene, 0);
  for (const auto& sample : probes[0].patches[0].samples) {
    EXPECT_NEAR((sample.position_m - Vec2(0.1, 0.2)).norm(), 0.023, 1e-15);
  }
}

TEST(SceneFile, EveryBadFieldIsNamedWithItsLine) {
  const auto error_of = [](const std::string& text) {
    return sim::parse_scene(text, "scene.textproto").error;
  };
  const std::string good = probe("sigma_m: 1e-5", "start_t: 0 arc_m: 0.02 spacing_m: 2e-4");
  EXPECT_EQ(error_of(good), "");
  EXPECT_THAT(error_of("nonsense: 1\n"), StartsWith("scene.textproto:1:"));
  EXPECT_THAT(error_of(""), StartsWith("scene.textproto"));
  EXPECT_THAT(error_of(probe("sigma_m: -1", "start_t: 0 arc_m: 0.02 spacing_m: 2e-4")),
              StartsWith("scene.textproto:4: noise.sigma_m"));
  EXPECT_THAT(error_of(probe("", "start_t: 0 arc_m: 0 spacing_m: 2e-4")), HasSubstr("arc_m"));
  EXPECT_THAT(error_of(probe("", "start_t: 0 arc_m: 0.02 spacing_m: -2e-4")),
              HasSubstr("spacing_m"));
  EXPECT_THAT(error_of(probe("spike_probability: 2", "start_t: 0 arc_m: 0.02 spacing_m: 2e-4")),
              HasSubstr("spike_probability"));
  EXPECT_THAT(
      error_of("curve { curve_class: CURVE_CLASS_ELLIPSE parameters { a: 1 } }\n" + good.substr(8)),
      StartsWith("scene.textproto"));
  EXPECT_THAT(error_of(std::string(kCircle) +
                       "probes { name: \"a b\" patches { start_t: 0 arc_m: 1 spacing_m: 1 } }"),
              HasSubstr("name"));
}

std::string with_probe(const std::string& probe_fields, const std::string& patches) {
  return std::string(kCircle) + "probes { name: \"p\" " + probe_fields + " " + patches + " }\n";
}

TEST(Simulation, OffsetAndLobesGoOutAlongTheNormal) {
  const sim::Scene scene = scene_of(with_probe(
      "tip_radius_m: 0.003 offset_m: -2e-5 lobes { order: 2 cosine_m: 3e-5 sine_m: 1e-5 }",
      "patches { start_t: 0 arc_m: 0.1 spacing_m: 1e-3 }"));
  const auto probes = sim::simulate_contacts(scene, 0);
  for (const auto& sample : probes[0].patches[0].samples) {
    const Vec2 from = sample.position_m - Vec2(0.1, 0.2);
    const double off = -2e-5 + 3e-5 * std::cos(2 * sample.t) + 1e-5 * std::sin(2 * sample.t);
    EXPECT_NEAR(from.norm(), 0.023 + off, 1e-15);
    EXPECT_NEAR(std::remainder(std::atan2(from.y(), from.x()) - sample.t, 2 * kPi), 0.0, 1e-12);
  }
}

TEST(Simulation, ALagLeavesTheOffsetAheadOfThePlaceBothWays) {
  const std::string patches =
      "patches { start_t: 0 arc_m: 0.05 spacing_m: 1e-3 }"
      "patches { start_t: 3 arc_m: 0.05 spacing_m: 1e-3 backwards: true }";
  const sim::Scene scene = scene_of(
      with_probe("tip_radius_m: 0.005 lag_m: 5e-4 lobes { order: 3 sine_m: 4e-5 }", patches));
  const auto probes = sim::simulate_contacts(scene, 0);
  for (std::size_t patch = 0; patch < 2; ++patch) {
    const double ahead = (patch == 0 ? 1.0 : -1.0) * 5e-4 / 0.025;
    for (const auto& sample : probes[0].patches[patch].samples) {
      const Vec2 from = sample.position_m - Vec2(0.1, 0.2);
      const double angle = std::atan2(from.y(), from.x());
      // The offset's normal is turned by the lag: its part along the circle moves the angle by
      // 4e-5 * 0.02 / 0.025 at most, the rest is shorter by half of 0.02 squared.
      EXPECT_NEAR(std::remainder(angle - (sample.t - ahead), 2 * kPi), 0.0, 3.3e-5);
      EXPECT_NEAR(from.norm(), 0.025 + 4e-5 * std::sin(3 * sample.t), 1e-8);
    }
  }
}

TEST(Simulation, DriftHasItsSizeAndItsLength) {
  const sim::Scene scene = scene_of(with_probe("drift_m: 1e-5 drift_length_m: 2e-3",
                                               "patches { start_t: 0 arc_m: 4 spacing_m: 1e-3 }"));
  const auto probes = sim::simulate_contacts(scene, 0);
  const auto& samples = probes[0].patches[0].samples;
  ASSERT_EQ(samples.size(), 4001U);
  double square = 0.0;
  double product = 0.0;
  double last = 0.0;
  for (const auto& sample : samples) {
    const double drift = (sample.position_m - Vec2(0.1, 0.2)).norm() - 0.02;
    square += drift * drift / 4001.0;
    product += drift * last / 4000.0;
    last = drift;
  }
  // Four deviations: 4,001 samples correlated by exp(-1/2) are worth 4001 (1 - r^2) / (1 + r^2).
  const double r = std::exp(-0.5);
  const double share = 4.0 * std::sqrt(2.0 / (4001.0 * (1.0 - r * r) / (1.0 + r * r)));
  EXPECT_NEAR(square, 1e-10, share * 1e-10);
  EXPECT_NEAR(product / square, r, 4.0 * std::sqrt((1.0 - r * r) / 4001.0));
}

TEST(Simulation, AnIdealProbeHasTheSamplesThatItAlwaysHad) {
  const std::string patches = "patches { start_t: 0 arc_m: 0.05 spacing_m: 1e-3 }";
  const auto plain =
      sim::simulate_contacts(scene_of(with_probe("noise { sigma_m: 1e-5 }", patches)));
  const auto drifting = sim::simulate_contacts(
      scene_of(with_probe("noise { sigma_m: 1e-5 } drift_m: 1e-6 drift_length_m: 1e-2", patches)));
  for (std::size_t i = 0; i < plain[0].patches[0].samples.size(); ++i) {
    const Vec2 off =
        drifting[0].patches[0].samples[i].position_m - plain[0].patches[0].samples[i].position_m;
    EXPECT_LT(off.norm(), 6e-6);  // the drift alone: noise has drawn the same numbers
    EXPECT_GT(off.norm(), 0.0);
  }
}

TEST(Simulation, ABadProbeIsNamed) {
  const std::string patches = "patches { start_t: 0 arc_m: 0.05 spacing_m: 1e-3 }";
  for (const auto& [fields, why] : std::vector<std::pair<std::string, std::string>>{
           {"drift_m: 1e-6", "probes[0].drift_length_m: must be a number > 0"},
           {"lag_m: -1", "probes[0].lag_m: must be a number >= 0"},
           {"offset_m: nan", "probes[0].offset_m: must be a number"},
           {"lobes { sine_m: 1 }", "probes[0].lobes[0].order: must be at least 1"},
           {"lobes { order: 2 sine_m: inf }", "probes[0].lobes[0].sine_m: must be a number"}}) {
    const auto scene = sim::parse_scene(with_probe(fields, patches), "scene.textproto");
    EXPECT_THAT(scene.error, HasSubstr(why));
    EXPECT_THAT(scene.error, StartsWith("scene.textproto:"));
  }
}

}  // namespace
}  // namespace palpate
