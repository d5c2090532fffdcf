// Round tips of several radii on one side of a part: their centres lie on different curves.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <optional>
#include <random>
#include <vector>

#include "core/curves/curve.h"
#include "core/recognition/recognizer.h"
#include "core/recognition/samples/work_limit.h"
#include "tests/support/answered_touches.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/random_scene.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kSigma_m = 2e-5;

/// Where a tip touched.
struct TipContact {
  std::uint32_t place = 0;
  double tip_m = 0.0;
  Vec2 centre_m;
  Vec2 normal;  ///< out of the material
};

/// How often a part is touched: in so many places, and so often in each.
struct Touched {
  int places = 4;
  int points_per_place = 80;
};

/// A part of a class, 30 mm large, touched from outside of its bends or, if it has
/// no outside, from the left of its travel, by a tip of its own radius in each place or, one after
/// the other, by all; empty where a tip does not reach.
std::vector<TipContact> touched_by_tips(CurveClass curve_class, const Touched& touched,
                                        std::array<double, 3> tips_m, bool take_turns,
                                        std::mt19937_64& rng) {
  std::shuffle(tips_m.begin(), tips_m.end(), rng);
  test::SceneOptions options;
  options.patches = touched.places;
  options.points_per_patch = touched.points_per_place;
  options.sigma_over_size = 0.0;
  options.size_m = 0.03;
  const test::Scene scene = test::random_scene(curve_class, options, rng);
  const auto curve = make_curve(curve_class, scene.values);
  const bool has_outside =
      curve_class == CurveClass::Circle || curve_class == CurveClass::Ellipse ||
      curve_class == CurveClass::Parabola || curve_class == CurveClass::Hyperbola;
  std::vector<TipContact> contacts;
  for (std::uint32_t place = 0; place < scene.patches.size(); ++place) {
    for (std::size_t i = 0; i < scene.patches[place].size(); ++i) {
      const double tip_m = tips_m[(take_turns ? contacts.size() : place) % tips_m.size()];
      const LocalGeometry local = geometry(*curve, scene.t[place][i]);
      const Vec2 along(std::cos(local.tangent_angle), std::sin(local.tangent_angle));
      const double side = has_outside ? -std::copysign(1.0, local.kappa) : 1.0;
      if (side * local.kappa * tip_m > 0.8) {
        return {};
      }
      const Vec2 normal = side * scene.world_T_curve.rotate(left_of(along));
      const Vec2 centre_m = scene.patches[place][i] + tip_m * normal;
      contacts.push_back({place, tip_m, centre_m + test::normal_pair(rng, kSigma_m), normal});
    }
  }
  return contacts;
}

Recognizer recognizer_of_tips() {
  RecognizerOptions options;
  options.sigma_m = kSigma_m;
  options.patience = kPatienceWithFiles;
  return Recognizer(options);
}

std::optional<Recognition> answer_by_strokes(CurveClass curve_class, const Touched& strokes,
                                             std::mt19937_64& rng) {
  const auto contacts = touched_by_tips(curve_class, strokes, {1e-4, 3e-3, 1e-2}, false, rng);
  if (contacts.empty()) {
    return std::nullopt;
  }
  Recognizer recognizer = recognizer_of_tips();
  for (const TipContact& contact : contacts) {
    const ContactSample sample{contact.centre_m, 0.0, 0};
    recognizer.add({0, contact.place, contact.tip_m}, {&sample, 1});
  }
  return recognizer.recognize();
}

/// Twenty single touches, each with its normal.
std::optional<Recognition> answer_by_touches(CurveClass curve_class, std::mt19937_64& rng) {
  constexpr double kNormalSigma = 0.05;  // rad
  const auto contacts = touched_by_tips(curve_class, {4, 5}, {5e-4, 2e-3, 5e-3}, true, rng);
  if (contacts.empty()) {
    return std::nullopt;
  }
  Recognizer recognizer = recognizer_of_tips();
  std::normal_distribution<double> turned(0.0, kNormalSigma);
  PatchContext context;
  for (const TipContact& contact : contacts) {
    context.tip_radius_m = contact.tip_m;
    const ContactSample sample{contact.centre_m, 0.0, 0};
    const SampleDetail detail{Eigen::Rotation2Dd(turned(rng)) * contact.normal, kNormalSigma};
    recognizer.add(context, {&sample, 1}, {&detail, 1});
    ++context.patch;
  }
  return recognizer.recognize();
}

template <typename AnswerTo>
void expect_true_answers(const AnswerTo& answer_to) {
  constexpr double kImprobable = 1e-4;
  std::mt19937_64 rng = test::test_rng();
  for (const CurveClass curve_class : kCurveClasses) {
    int scenes = 0;
    int improbable = 0;
    int recognized = 0;
    int wrong = 0;
    double stated_wrong = 0.0;
    while (scenes < test::stress_count(40)) {
      const auto answer = answer_to(curve_class, rng);
      if (!answer) {
        continue;
      }
      ++scenes;
      const Hypothesis* const truth = test::hypothesis_of(*answer, curve_class);
      improbable += truth == nullptr || truth->probability < kImprobable ? 1 : 0;
      if (answer->status == RecognitionStatus::Recognized) {
        (answer->shape.curve_class == curve_class ? recognized : wrong) += 1;
        stated_wrong += test::stated_doubt(*answer);
      }
    }
    std::cout << name_of(curve_class) << ": of " << scenes << " RECOGNIZED " << recognized
              << ", as another " << wrong << " (as told " << stated_wrong << "); truth improbable "
              << improbable << '\n';
    EXPECT_LE(wrong, test::most_of_poisson(stated_wrong));
    EXPECT_LE(improbable, test::most_of_poisson(kImprobable * scenes));
  }
}

// Sides and travel of strokes that do not show them came from a curve through all centres, of which
// there is none: edges had no probability, and parts with strokes that hardly bend were RECOGNIZED
// as of no class.
TEST(TipsOfOtherRadii, AreOnOneSideOfThePart) {
  expect_true_answers([](CurveClass curve_class, std::mt19937_64& rng) {
    return answer_by_strokes(curve_class, {4, 80}, rng);
  });
}

// Of many strokes the sides have too many ways to try the classes in all.
TEST(TipsOfOtherRadii, AreOnOneSideOfThePartInManyStrokes) {
  expect_true_answers([](CurveClass curve_class, std::mt19937_64& rng) {
    return answer_by_strokes(curve_class, {8, 40}, rng);
  });
}

// Directions of single touches came from that curve, too, and not from what was measured.
TEST(TipsOfOtherRadii, TouchWhereTheirNormalsAreMeasured) {
  expect_true_answers(answer_by_touches);
}

}  // namespace
}  // namespace palpate
