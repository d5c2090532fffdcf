// Short ways: patches of two samples, strokes that turn back at an end or go round the end of a
// needle, places that are held, and a single bad sample where a stroke begins.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/recognition/recognizer.h"
#include "tests/support/answered_scene.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

double probability_of(const Recognition& answer, CurveClass curve_class) {
  const Hypothesis* found = test::hypothesis_of(answer, curve_class);
  return found != nullptr ? found->probability : 0.0;
}

/// A stroke of an ellipse of 30 by 18 mm, `arc` rad of its eccentric angle from anywhere.
std::vector<Vec2> stroke_of_ellipse(std::size_t count, double arc, std::mt19937_64& rng) {
  const double from = test::uniform(rng, 0.0, 2.0 * kPi);
  std::vector<Vec2> stroke;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = from + arc * static_cast<double>(i) / static_cast<double>(count - 1);
    stroke.emplace_back(0.030 * std::cos(t), 0.018 * std::sin(t));
  }
  return stroke;
}

void add_noise(double sigma_m, std::vector<Vec2>* stroke, std::mt19937_64& rng) {
  std::normal_distribution<double> noise(0.0, sigma_m);
  for (Vec2& place : *stroke) {
    const double x = noise(rng);
    place += Vec2(x, noise(rng));
  }
}

/// Places of an ellipse at even distances along it.
std::vector<Vec2> round_ellipse(double a, double b, std::size_t count, double from) {
  constexpr int kSteps = 20000;
  std::vector<Vec2> places;
  std::vector<double> way;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = 2.0 * kPi * (from + static_cast<double>(i) / kSteps);
    places.emplace_back(a * std::cos(t), b * std::sin(t));
    way.push_back(i == 0 ? 0.0 : way.back() + (places.back() - places[places.size() - 2]).norm());
  }
  std::vector<Vec2> stroke;
  for (std::size_t k = 0; k < count; ++k) {
    const double s = way.back() * static_cast<double>(k) / static_cast<double>(count - 1);
    const auto next = std::lower_bound(way.begin(), way.end(), s) - way.begin();
    stroke.push_back(places[static_cast<std::size_t>(next)]);
  }
  return stroke;
}

Recognition answer_to(const std::vector<std::vector<Vec2>>& strokes, double sigma_m) {
  test::Scene scene;
  scene.patches = strokes;
  return test::recognise(scene, sigma_m);
}

// Between two samples a curve is longer than their chord, which is all that there is of the stroke.
TEST(ShortWays, PatchesOfTwoSamplesExcludeNoClass) {
  auto rng = test::test_rng();
  test::SceneOptions options;
  options.patches = 5;
  options.points_per_patch = 60;
  options.sigma_over_size = 3e-4;
  options.least_fraction = 0.05;
  options.most_fraction = 0.15;
  for (const CurveClass curve_class : {CurveClass::Parabola, CurveClass::CubicalParabola,
                                       CurveClass::SemiCubicalParabola, CurveClass::CubicSpline}) {
    for (int i = 0; i < test::stress_count(12); ++i) {
      test::Scene scene = test::random_scene(curve_class, options, rng);
      for (const std::size_t pair : {3U, 4U}) {
        scene.patches[pair] = {scene.patches[pair].front(), scene.patches[pair].back()};
      }
      EXPECT_LT(probability_of(test::recognise(scene, scene.sigma_m), CurveClass::Unclassified),
                0.5)
          << name_of(curve_class) << " " << i;
    }
  }
}

TEST(ShortWays, AStrokeThatTurnsBackAtAnEndIsOfItsEllipse) {
  constexpr double kSigma = 1e-5;
  auto rng = test::test_rng();
  for (const std::size_t back : {1U, 3U, 4U, 5U, 6U, 7U, 10U, 20U, 40U}) {
    for (int i = 0; i < test::stress_count(6); ++i) {
      std::vector<Vec2> stroke = stroke_of_ellipse(120, 3.0, rng);
      const std::vector<Vec2> way = stroke;
      if (i % 2 == 0) {  // at its beginning
        stroke.assign(way.begin() + 1, way.begin() + 1 + static_cast<std::ptrdiff_t>(back));
        std::reverse(stroke.begin(), stroke.end());
        stroke.insert(stroke.end(), way.begin(), way.end());
      } else {
        stroke.insert(stroke.end(), way.rbegin() + 1,
                      way.rbegin() + 1 + static_cast<std::ptrdiff_t>(back));
      }
      add_noise(kSigma, &stroke, rng);
      const Recognition answer = answer_to({stroke}, kSigma);
      EXPECT_EQ(answer.status, RecognitionStatus::Recognized) << back << " " << i;
      EXPECT_EQ(answer.shape.curve_class, CurveClass::Ellipse) << back << " " << i;
    }
  }
}

// Held for a multiple of no block's length, with a noise that leads from one place to the next by
// no sample.
// Round the end of a needle, sharper than the samples lie apart, the chord of a sample's neighbours
// may lead back: the stroke does not.
TEST(ShortWays, RoundTheEndOfAThinEllipseNoStrokeTurnsBack) {
  constexpr double kHalfLength = 0.050;
  auto rng = test::test_rng();
  for (const double ratio : {0.03, 0.04, 0.06, 0.1}) {
    for (const double sigma_m : {5e-5, 2e-4}) {
      for (int i = 0; i < test::stress_count(20); ++i) {
        std::vector<Vec2> stroke =
            round_ellipse(kHalfLength, ratio * kHalfLength, 120, test::uniform(rng, 0.0, 1.0));
        add_noise(sigma_m, &stroke, rng);
        EXPECT_LT(probability_of(answer_to({stroke}, sigma_m), CurveClass::Unclassified), 0.5)
            << "ratio " << ratio << ", noise " << sigma_m << ", " << i;
      }
    }
  }
}

TEST(ShortWays, ACircleThatIsHeldAtEachPlaceIsNoEllipse) {
  constexpr double kRadius = 0.03;
  auto rng = test::test_rng();
  for (const double sigma_m : {1e-4 * kRadius, 1e-3 * kRadius}) {
    for (const auto& [places, held] : {std::pair(5, 10), {8, 20}, {12, 20}}) {
      for (int i = 0; i < test::stress_count(10); ++i) {
        std::vector<std::vector<Vec2>> strokes(2);
        for (std::vector<Vec2>& stroke : strokes) {
          const double from = test::uniform(rng, 0.0, 2.0 * kPi);
          for (int k = 0; k < places * held; ++k) {
            const double t = from + 2.5 * (k / held) / (places - 1);
            stroke.emplace_back(kRadius * std::cos(t), kRadius * std::sin(t));
          }
          add_noise(sigma_m, &stroke, rng);
        }
        const Recognition answer = answer_to(strokes, sigma_m);
        EXPECT_EQ(answer.shape.curve_class, CurveClass::Circle) << sigma_m << " " << places;
        // A step as long as those between places, once in 65,000, leaves seven samples at most.
        const auto samples = static_cast<std::size_t>(2 * places * held);
        EXPECT_GE(answer.dwelling_count + 8, samples - static_cast<std::size_t>(2 * places));
      }
    }
  }
}

// A quartic bends to it.
TEST(ShortWays, ABadFirstSampleIsSetAside) {
  constexpr double kSigma = 5e-5;
  auto rng = test::test_rng();
  for (int i = 0; i < test::stress_count(40); ++i) {
    std::vector<std::vector<Vec2>> strokes(2);
    const double turn = test::uniform(rng, -kPi, kPi);
    for (int k = 0; k < 240; ++k) {
      const Pose2 pose{0.1, -0.2, turn};
      strokes[k < 120 ? 0 : 1].push_back(pose * Vec2(3e-4 * (k < 120 ? k : k + 40), 0.0));
    }
    for (std::vector<Vec2>& stroke : strokes) add_noise(kSigma, &stroke, rng);
    const double off = test::random_sign(rng) * test::log_uniform(rng, 25.0, 150.0) * kSigma;
    strokes[0].front() += off * Vec2(-std::sin(turn), std::cos(turn));
    const Recognition answer = answer_to(strokes, kSigma);
    EXPECT_EQ(answer.shape.curve_class, CurveClass::Line) << off / kSigma;
    EXPECT_GE(answer.outlier_count, 1U) << off / kSigma;
  }
}

}  // namespace
}  // namespace palpate
