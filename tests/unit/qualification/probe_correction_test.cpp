// A part touched by a qualified probe: at the bound with its file, and honest.
#include "core/qualification/probed_recognition.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <iostream>

#include "core/numerics/probability/chi_square.h"
#include "core/qualification/qualify.h"
#include "tests/support/calibration.h"
#include "tests/support/probe_scene.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

std::vector<ProbedPatch> patches_of(const ArtefactRecording& recording,
                                    const ProbeCharacter* probe) {
  std::vector<ProbedPatch> patches;
  for (const ArtefactStroke& stroke : recording.strokes) {
    ProbedPatch& patch = patches.emplace_back();
    patch.context.patch = static_cast<std::uint32_t>(patches.size());
    patch.context.tip_radius_m = stroke.tip_radius_m;
    patch.samples = stroke.samples;
    patch.probe = probe;
  }
  return patches;
}

TEST(ProbeCorrection, WithTheFileTheEllipseIsAtTheBoundAndHeld) {
  auto rng = test::test_rng();
  const int runs = test::stress_count(40);
  test::ProbeScene ring;
  ring.probe = test::lobed_probe();
  test::ProbeScene part = ring;
  part.curve = Ellipse{0.03, 0.022};
  part.start_t = 0.4;
  part.arc_t = 1.2 * kPi;
  const Eigen::Vector2d truth(0.03, 0.022);
  int held = 0;
  int held_without = 0;
  double with = 0.0;
  double without = 0.0;
  double normalised = 0.0;
  for (int run = 0; run < runs; ++run) {
    const std::vector<ArtefactRecording> recordings = {simulate(ring, rng)};
    QualificationOptions one_setup;
    one_setup.same_setup = true;  // the scenes' probe has one constant
    const Qualification qualification = qualify(ring.curve, recordings, one_setup);
    const ArtefactRecording touched = simulate(part, rng);
    RecognizerOptions options;
    const ProbedRecognition answer =
        recognise_probed(patches_of(touched, &qualification.probe), options);
    ASSERT_TRUE(answer.corrected);
    ASSERT_EQ(answer.recognition.shape.curve_class, CurveClass::Ellipse);
    const Recognition plain = recognise_probed(patches_of(touched, nullptr), options).recognition;
    const auto error = [&](const Recognition& r) -> Eigen::Vector2d {
      return r.shape.values.head<2>() - truth;
    };
    const auto squared = [&](const Recognition& r) {
      const Eigen::Matrix2d covariance = r.covariance.topLeftCorner<2, 2>();
      return error(r).dot(covariance.inverse() * error(r));
    };
    normalised += squared(answer.recognition) / runs;
    held += squared(answer.recognition) <= chi_square_threshold(0.05, 2) ? 1 : 0;
    held_without += squared(plain) <= chi_square_threshold(0.05, 2) ? 1 : 0;
    with += error(answer.recognition).squaredNorm() / runs;
    without += error(plain).squaredNorm() / runs;
  }
  std::cout << "rms error " << std::sqrt(with) << " m with the file, " << std::sqrt(without)
            << " without; held " << held << " and " << held_without << " of " << runs
            << ", squared error over covariance " << normalised << " (law: 2)\n";
  if (!test::counts_tell()) return;
  const auto band = [&](double p) {
    return test::binomial_band(std::vector<double>(static_cast<std::size_t>(runs), p), 1.0 - 2e-4);
  };
  EXPECT_GE(held, band(0.95).least);
  // Of the chi-square law with two degrees of freedom, mean 2 and variance 4.
  EXPECT_NEAR(normalised, 2.0, 4.0 * 2.0 / std::sqrt(runs));
  EXPECT_LT(with, without);  // what the file is for
  // Without it the residuals tell how large such deviations are, and the answer holds the truth.
  EXPECT_GE(held_without, band(0.9).least);
}

// Lobes of forty times the noise hide the class, until they are taken off along some curve's
// normals.
TEST(ProbeCorrection, LobesFarAboveTheNoiseHideNoClass) {
  auto rng = test::test_rng();
  test::ProbeScene part;
  part.probe = test::lobed_probe();
  part.probe.sigma_m.value = 2.5e-6;
  part.probe.deviation_m.value = 1.5e-6;
  const auto coefficients = offset_coefficients(part.probe.offset.order);
  part.probe.offset.covariance_m2 = Eigen::MatrixXd::Zero(coefficients, coefficients);
  constexpr double kLarger = 40.0;
  part.probe.offset.coefficients_m *=
      kLarger * part.probe.sigma_m.value / std::sqrt(mean_square_of_lobes(part.probe.offset));
  part.curve = Ellipse{0.03, 0.022};
  part.arc_t = 1.5 * kPi;
  for (int run = 0; run < test::stress_count(20); ++run) {
    part.start_t = test::uniform(rng, 0.0, 2.0 * kPi);
    const ProbedRecognition answer =
        recognise_probed(patches_of(simulate(part, rng), &part.probe), {});
    EXPECT_TRUE(answer.corrected);
    EXPECT_EQ(answer.recognition.shape.curve_class, CurveClass::Ellipse);
  }
}

// A file speaks for its own probe only.
TEST(ProbeCorrection, AProbeBesideOneWithAFileIsUnqualifiedUnlessItsNoiseIsStated) {
  auto rng = test::test_rng();
  test::ProbeScene ring;
  ring.probe = test::lobed_probe();
  const std::vector<ArtefactRecording> recordings = {simulate(ring, rng)};
  const Qualification qualification = qualify(ring.curve, recordings);
  test::ProbeScene part = ring;
  part.curve = Ellipse{0.03, 0.022};
  std::vector<ProbedPatch> patches = patches_of(simulate(part, rng), &qualification.probe);
  ASSERT_GT(patches.size(), 1U);
  const auto answer_to = [&](std::optional<bool> unqualified, double sigma_m) {
    RecognizerOptions options;
    options.unqualified_probe = unqualified;
    options.sigma_m = sigma_m;
    return recognise_probed(patches, options).recognition;
  };
  EXPECT_FALSE(answer_to(std::nullopt, 0.0).unqualified_probe);
  EXPECT_FALSE(answer_to(true, 0.0).unqualified_probe);  // no patch that this concerns
  patches.back().probe = nullptr;
  for (ContactSample& sample : patches.back().samples) sample.sigma_m = 0.0;
  const Recognition untold = answer_to(std::nullopt, 0.0);
  EXPECT_TRUE(untold.unqualified_probe);
  EXPECT_FALSE(answer_to(false, 0.0).unqualified_probe);
  EXPECT_GT(untold.covariance(0, 0), answer_to(false, 0.0).covariance(0, 0));
  // What noise alone would leave contains nothing of the file's deviations either.
  EXPECT_LT(noise_covariance(untold)(0, 0), answer_to(false, 0.0).covariance(0, 0));
  EXPECT_FALSE(answer_to(std::nullopt, 1e-5).unqualified_probe);
  EXPECT_TRUE(answer_to(true, 1e-5).unqualified_probe);
}

// What neighbours share stands in the local estimates too.
TEST(ProbeCorrection, WithoutTheFileContactsHoldTheCurvature) {
  auto rng = test::test_rng();
  const int runs = test::stress_count(40);
  test::ProbeScene part;
  part.probe = test::lobed_probe();
  part.curve = Ellipse{0.03, 0.022};
  part.start_t = 0.4;
  part.arc_t = 1.2 * kPi;
  std::vector<double> shares;
  int held = 0;
  double squares_of_kappa = 0.0;
  double squares_of_kappa_s = 0.0;
  for (int run = 0; run < runs; ++run) {
    std::vector<ProbedPatch> patches = patches_of(simulate(part, rng), nullptr);
    for (std::size_t p = 0; p < patches.size(); ++p) {
      patches[p].context.material_side = p % 2 == 0 ? MaterialSide::Left : MaterialSide::Right;
    }
    const Recognition answer = recognise_probed(patches, {}).recognition;
    for (const LocalizedContact& contact : answer.contacts) {
      const Pose2& pose = part.world_T_curve;
      const FootPoint foot = foot_point(part.curve, pose.to_local(contact.estimate.position));
      const LocalGeometry truth = geometry(part.curve, foot.t);
      const double sign = contact.estimate.kappa < 0.0 ? -1.0 : 1.0;  // travel either way
      const Eigen::Vector2d off(contact.estimate.kappa - sign * truth.kappa,
                                contact.estimate.kappa_s - truth.kappa_s);
      const Eigen::Matrix2d covariance = contact.estimate.covariance.bottomRightCorner<2, 2>();
      if (!covariance.allFinite()) continue;
      shares.push_back(0.95);
      held += off.dot(covariance.inverse() * off) <= chi_square_threshold(0.05, 2) ? 1 : 0;
      squares_of_kappa += off[0] * off[0] / covariance(0, 0);
      squares_of_kappa_s += off[1] * off[1] / covariance(1, 1);
    }
  }
  const auto count = static_cast<double>(shares.size());
  std::cout << "contacts: " << held << " of " << count << " held; rms of error over deviation "
            << std::sqrt(squares_of_kappa / count) << " (kappa), "
            << std::sqrt(squares_of_kappa_s / count) << " (kappa_s)\n";
  if (!test::counts_tell()) return;
  EXPECT_GT(shares.size(), 4U * static_cast<unsigned>(runs));
  EXPECT_GE(held, test::binomial_band(shares, 1.0 - 2e-4).least);
}

// Five recordings tell how far the constant differs between set-ups; the part is in a sixth.
TEST(ProbeCorrection, InAnotherSetupTheEllipseIsHeld) {
  auto rng = test::test_rng();
  std::normal_distribution<double> normal;
  const int runs = test::stress_count(20);
  test::ProbeScene ring;
  ring.probe = test::lobed_probe();
  ring.samples = 100;
  const double constant = ring.probe.offset.coefficients_m[0];
  const Eigen::Vector2d truth(0.03, 0.022);
  int held = 0;
  double normalised = 0.0;
  for (int run = 0; run < runs; ++run) {
    const auto in_a_setup = [&](test::ProbeScene scene) {
      scene.probe.offset.coefficients_m[0] = constant + 3e-5 * normal(rng);
      return simulate(scene, rng);
    };
    std::vector<ArtefactRecording> recordings;
    for (int i = 0; i < 5; ++i) recordings.push_back(in_a_setup(ring));
    const Qualification qualification = qualify(ring.curve, recordings);
    test::ProbeScene part = ring;
    part.curve = Ellipse{0.03, 0.022};
    part.start_t = 0.4;
    part.arc_t = 1.2 * kPi;
    const Recognition answer =
        recognise_probed(patches_of(in_a_setup(part), &qualification.probe), {}).recognition;
    ASSERT_EQ(answer.shape.curve_class, CurveClass::Ellipse);
    const Eigen::Vector2d error = answer.shape.values.head<2>() - truth;
    const double squared = error.dot(answer.covariance.topLeftCorner<2, 2>().inverse() * error);
    held += squared <= chi_square_threshold(0.05, 2) ? 1 : 0;
    normalised += squared / runs;
  }
  std::cout << "held " << held << " of " << runs << ", squared error over covariance " << normalised
            << " (law: 2)\n";
  if (!test::counts_tell()) return;
  const test::Band band =
      test::binomial_band(std::vector<double>(static_cast<std::size_t>(runs), 0.95), 1.0 - 2e-4);
  EXPECT_GE(held, band.least);
}

// What the offset of another set-up differs by, by far more than the noise, moves, turns and bends
// the surface at a contact: each has a normal law over what is told, one value a set-up.
TEST(ProbeCorrection, InAnotherSetupTheContactsAreHeld) {
  auto rng = test::test_rng();
  std::normal_distribution<double> normal;
  const int runs = test::stress_count(40);
  test::ProbeScene part;
  part.probe = test::lobed_probe();
  part.probe.sigma_m.value = 1e-6;
  part.probe.deviation_m.value = 1e-7;
  part.probe.setup_m.value = 2e-4;
  constexpr double kLobes = 5e-5;  // uncertainty of each [m]
  const auto coefficients = offset_coefficients(part.probe.offset.order);
  part.probe.offset.covariance_m2 = Eigen::MatrixXd::Zero(coefficients, coefficients);
  part.probe.offset.covariance_m2.diagonal().tail(coefficients - 1).setConstant(kLobes * kLobes);
  const Curve curve = Ellipse{0.03, 0.022};
  part.curve = curve;
  part.arc_t = 1.5 * kPi;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();  // of place, direction and curvature
  for (int run = 0; run < runs; ++run) {
    test::ProbeScene there = part;
    Eigen::VectorXd& offset = there.probe.offset.coefficients_m;
    offset[0] += part.probe.setup_m.value * normal(rng);
    for (Eigen::Index k = 1; k < offset.size(); ++k) offset[k] += kLobes * normal(rng);
    const Recognition answer =
        recognise_probed(patches_of(simulate(there, rng), &part.probe), {}).recognition;
    ASSERT_FALSE(answer.contacts.empty());
    const LocalEstimate& told = answer.contacts[answer.contacts.size() / 2].estimate;
    const FootPoint foot = foot_point(curve, part.world_T_curve.to_local(told.position));
    const LocalGeometry truth = geometry(curve, foot.t);
    const double turned = told.tangent_angle - truth.tangent_angle - part.world_T_curve.theta;
    const double way = std::cos(turned) < 0.0 ? -1.0 : 1.0;  // strokes run either way
    const Eigen::Vector3d error(foot.distance, std::remainder(turned, kPi),
                                told.kappa - way * truth.kappa);
    squares += error.cwiseAbs2().cwiseQuotient(told.covariance.diagonal().head<3>());
  }
  std::cout << "mean squares of contacts' errors, of what is told: " << squares.transpose() / runs
            << "\n";
  EXPECT_LE(squares.maxCoeff(), chi_square_threshold(1e-4, runs));
  // Directions are told with the form deviation that the lobes' uncertainty counts as, besides.
  EXPECT_GE(squares[0], chi_square_threshold(1.0 - 1e-4, runs));
}

TEST(ProbeCorrection, FromMemoryTheSameAndFromMeansOfNeighboursNearly) {
  auto rng = test::test_rng();
  test::ProbeScene part;
  part.curve = Ellipse{0.03, 0.022};
  part.start_t = 0.4;
  part.arc_t = 1.2 * kPi;
  part.samples = 1000;  // four of them bend by less than their noise
  part.probe = test::lobed_probe();
  part.probe.spike_probability.value = 0.0;  // a mean hides them
  part.probe.deviation_m.value = 0.0;        // and makes drift stand out of the noise
  const Eigen::Index terms = part.probe.offset.coefficients_m.size();
  part.probe.offset.covariance_m2 = Eigen::MatrixXd::Zero(terms, terms);
  const std::vector<ProbedPatch> patches = patches_of(simulate(part, rng), &part.probe);
  const Recognition direct = recognise_probed(patches, {}).recognition;
  const ProbeCharacter* const probes[] = {&part.probe};
  for (const std::size_t most : {std::size_t{1024}, patches.front().samples.size() / 3}) {
    RecognizerOptions options;
    options.memory.most_samples_per_patch = most;
    SampleMemory memory(options.memory);
    std::size_t count = 0;
    for (const ProbedPatch& patch : patches) {
      count += memory.add(patch.context, patch.samples).accepted;
    }
    const ProbedRecognition answer = recognise_probed(memory, probes, options);
    EXPECT_TRUE(answer.corrected);
    EXPECT_EQ(answer.recognition.sample_count, count);
    ASSERT_EQ(answer.recognition.shape.curve_class, CurveClass::Ellipse);
    // Every sample alone is what it was; means of four hold the same information.
    const double tolerance = most == 1024 ? 1e-9 : 0.5;
    for (int k = 0; k < 2; ++k) {
      EXPECT_NEAR(answer.recognition.shape.values[k], direct.shape.values[k],
                  tolerance * std::sqrt(direct.covariance(k, k)));
    }
  }
}

TEST(ProbeCorrection, TakesOffWhatTheProbePutOn) {
  auto rng = test::test_rng();
  test::ProbeScene part;
  part.curve = Ellipse{0.03, 0.022};
  part.probe = test::lobed_probe();
  part.probe.sigma_m.value = 0.0;
  part.probe.deviation_m.value = 0.0;
  part.probe.spike_probability.value = 0.0;
  const ArtefactRecording lobed = simulate(part, rng);
  for (std::size_t s = 0; s < lobed.strokes.size(); ++s) {
    ProbedPatch patch{{}, lobed.strokes[s].samples, &part.probe};
    patch.context.tip_radius_m = part.tip_radius_m;
    const auto corrected = without_offset(patch, part.curve, part.world_T_curve);
    for (std::size_t i = 0; i < corrected.size(); ++i) {
      // Normal to the surface; along it the sample stays behind by its lag, 0.3 mm. The offset's
      // direction is ahead by kappa times that, to first order: with kappa up to 60 / m and a
      // relative change of it along the lag of 0.02, 5e-5 m lose less than 5e-5 * 3 * 0.02^2.
      const FootPoint foot =
          foot_point(part.curve, part.world_T_curve.to_local(corrected[i].position_m));
      EXPECT_NEAR(std::abs(foot.distance), part.tip_radius_m, 6e-8);
    }
  }
}

TEST(ProbeCorrection, CovarianceOfTheConstantIsThatOfACirclesRadius) {
  auto rng = test::test_rng();
  test::ProbeScene ring;
  ring.probe.sigma_m.value = 1e-6;
  ring.probe.deviation_length_m.value = 1.0;
  ProbeCharacter probe;
  probe.sigma_m.value = 1e-6;
  probe.deviation_length_m.value = 1.0;
  probe.offset.covariance_m2(0, 0) = 4e-10;
  const auto patches = patches_of(simulate(ring, rng), &probe);
  const ShapePoseCovariance covariance =
      covariance_of_probes(ring.curve, ring.world_T_curve, patches);
  EXPECT_NEAR(covariance(0, 0), 4e-10, 1e-14);
  EXPECT_NEAR(covariance(1, 1), 0.0, 1e-14);
}

}  // namespace
}  // namespace palpate
