// Points of a formula, without noise and none stated: what somebody tries first.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <vector>

#include "core/recognition/recognizer.h"
#include "tests/support/scene_data.h"
#include "tests/support/scene_prior.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

struct ExactAnswers {
  int right = 0;
  int wrong = 0;
  int cut = 0;  ///< by the limit of work

  void count(const Recognition& answer, CurveClass truth) {
    if (answer.status == RecognitionStatus::Recognized) {
      (answer.shape.curve_class == truth ? right : wrong) += 1;
    }
    cut += answer.doubt == Doubt::WorkLimit ? 1 : 0;
  }
};

TEST(ExactPoints, AreRecognizedAtLeastAsOftenAsNoisyOnes) {
  test::ScenePrior prior = test::classes_only(test::even_prior());
  prior.least_sigma_over_size = prior.most_sigma_over_size = 1e-3;
  const int scenes = test::stress_count(200);
  ExactAnswers exact;
  ExactAnswers noisy;
  for (int i = 0; i < scenes; ++i) {
    const test::PriorScene drawn =
        test::scene_from(prior, test::test_seed(), static_cast<std::uint32_t>(i));
    noisy.count(test::recognise(drawn.scene, 0.0), drawn.scene.curve_class);
    test::Scene formula = drawn.scene;
    formula.patches = drawn.exact_patches;
    exact.count(test::recognise(formula, 0.0), formula.curve_class);
  }
  std::cout << "  exact points: RECOGNIZED " << exact.right << " of " << scenes << ", wrong "
            << exact.wrong << ", by the limit of work " << exact.cut
            << "; with noise of a thousandth " << noisy.right << ", " << noisy.wrong << ", "
            << noisy.cut << "\n";
  EXPECT_EQ(exact.wrong, 0);
  if (test::counts_tell()) {
    EXPECT_GE(exact.right, noisy.right);
  }
}

/// One stroke along a curve about the origin, at even steps of its parameter. [m]
template <typename Place>
Recognition along(Place place, double span, int count) {
  std::vector<ContactSample> stroke;
  for (int i = 0; i < count; ++i) {
    stroke.push_back({place(span * i / (count - 1)), 0.0, 0});
  }
  Recognizer recognizer;
  recognizer.add({}, stroke);
  return recognizer.recognize();
}

/// Sections of a full turn do not follow it; that is no noise, and what the class leaves is none
/// either. Only the limit of work may be told.
TEST(ExactPoints, OfAConicAreNeverDoubted) {
  const double full_turn = 2.0 * kPi;
  int cut = 0;
  int answers = 0;
  const auto expect = [&](const Recognition& answer, CurveClass truth, double span, int count) {
    ++answers;
    cut += answer.doubt == Doubt::WorkLimit ? 1 : 0;
    EXPECT_EQ(answer.shape.curve_class, truth) << span << ", " << count;
    EXPECT_TRUE(answer.doubt == Doubt::None || answer.doubt == Doubt::WorkLimit)
        << name_of(truth) << " " << span << ", " << count << ": " << name_of(answer.doubt);
  };
  for (int count = 20; count < 420; count += 20) {
    for (const double span : {0.2 * full_turn, 0.5 * full_turn, full_turn}) {
      expect(along([](double t) { return Vec2(25e-3 * std::cos(t), 25e-3 * std::sin(t)); }, span,
                   count),
             CurveClass::Circle, span, count);
      expect(along([](double t) { return Vec2(30e-3 * std::cos(t), 20e-3 * std::sin(t)); }, span,
                   count),
             CurveClass::Ellipse, span, count);
    }
    for (const double span : {1.0, 2.0}) {
      expect(along([](double t) { return Vec2(10e-3 * t * t, 20e-3 * t); }, span, count),
             CurveClass::Parabola, span, count);
    }
  }
  std::cout << "  conics of " << answers << " lengths: cut by the limit of work " << cut << "\n";
}

}  // namespace
}  // namespace palpate
