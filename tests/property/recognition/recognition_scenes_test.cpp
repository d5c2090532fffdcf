// Thousands of random scenes: the class, the errors compared with the bound, and whether the
// published uncertainties are true.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <map>

#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kNoiseLevels[] = {1e-8, 1e-5, 1e-4, 5e-4, 1e-3, 2e-3};
constexpr int kScenesPerCell = 11;  // 8 classes x 4 numbers of patches x 6 levels x 11 = 2112

/// Results of the scenes of one noise level and number of patches.
struct Cell {
  int scenes = 0;
  int best_right = 0;  ///< the most probable class is the true one
  int recognised = 0;
  int wrong = 0;  ///< recognised as another class
};

void print(const std::map<std::pair<double, int>, Cell>& cells) {
  std::cout << "by noise and patches: recognised / most probable class right / recognised wrongly, "
               "of scenes\n"
            << "  sigma/size";
  for (int patches = 1; patches <= 4; ++patches) {
    std::cout << "\t" << patches << (patches == 1 ? " patch" : " patches");
  }
  for (const double level : kNoiseLevels) {
    std::cout << "\n  " << level;
    for (int patches = 1; patches <= 4; ++patches) {
      const Cell& cell = cells.at({level, patches});
      std::cout << "\t" << cell.recognised << "/" << cell.best_right << "/" << cell.wrong << " of "
                << cell.scenes;
    }
  }
  std::cout << "\n";
}

struct Statistics {
  double squares[6] = {};
  int count = 0;
};

/// What the recogniser is told: the noise, or that the probe errs by noise alone, or nothing.
enum class Told { Noise, OnlyNoise, Nothing };

void run(Told told) {
  std::mt19937_64 rng = test::test_rng(told == Told::Noise ? 1 : 0);
  RecognizerOptions recognizer;
  if (told == Told::OnlyNoise) recognizer.unqualified_probe = false;
  int recognised = 0;
  int wrong = 0;
  int scenes = 0;
  std::map<CurveClass, Statistics> statistics;
  std::map<std::pair<double, int>, Cell> cells;
  std::map<std::pair<CurveClass, CurveClass>, int> confusion;
  for (const double level : kNoiseLevels) {
    for (int patches = 1; patches <= 4; ++patches) {
      for (const CurveClass curve_class : kCurveClasses) {
        for (int i = 0; i < test::stress_count(kScenesPerCell); ++i) {
          test::SceneOptions options;
          options.patches = patches;
          options.sigma_over_size = level;
          const test::Scene scene = test::random_scene(curve_class, options, rng);
          const Recognition answer =
              test::recognise(scene, told == Told::Noise ? scene.sigma_m : 0.0, recognizer);
          ++scenes;
          Cell& cell = cells[{level, patches}];
          ++cell.scenes;
          cell.best_right += answer.shape.curve_class == curve_class ? 1 : 0;
          ++confusion[{curve_class, answer.shape.curve_class}];
          if (answer.status != RecognitionStatus::Recognized) {
            continue;
          }
          ++recognised;
          ++cell.recognised;
          if (answer.shape.curve_class != curve_class) {
            ++wrong;
            ++cell.wrong;
            std::cout << "wrong: " << name_of(curve_class) << " as "
                      << name_of(answer.shape.curve_class) << ", " << patches
                      << " patches, sigma/size " << level << ", probability "
                      << answer.hypotheses.front().probability << "\n";
            continue;
          }
          const auto letters = static_cast<Eigen::Index>(parameter_letters(curve_class).size());
          bool determined = letters > 0;
          for (Eigen::Index k = 0; k < letters; ++k) {
            determined = determined &&
                         std::sqrt(answer.covariance(k, k)) <= 0.03 * std::abs(scene.values[k]);
          }
          if (!determined) {
            continue;
          }
          const Eigen::VectorXd error = test::error_of(answer.hypotheses.front(), scene);
          Statistics& s = statistics[curve_class];
          ++s.count;
          for (Eigen::Index k = 0; k < error.size(); ++k) {
            if (answer.covariance(k, k) > 0.0) {
              s.squares[k] += error[k] * error[k] / answer.covariance(k, k);
            }
          }
        }
      }
    }
  }
  if (!test::counts_tell()) {
    return;
  }
  EXPECT_GE(scenes, 2000);
  // More than half of the scenes can be recognised; fewer than one in a hundred of these is wrong.
  EXPECT_GT(recognised, scenes / 2);
  EXPECT_LT(100 * wrong, recognised);
  std::cout << "scenes " << scenes << ", recognised " << recognised << ", of those wrong " << wrong
            << "\n";
  print(cells);
  std::cout << "confusion: true class by row, most probable one by column\n  ";
  for (int k = 0; k < 9; ++k) {
    std::cout << "\t" << name_of(static_cast<CurveClass>(k));
  }
  std::cout << "\n";
  for (const CurveClass truth : kCurveClasses) {
    std::cout << "  " << name_of(truth);
    for (int k = 0; k < 9; ++k) {
      std::cout << "\t" << confusion[{truth, static_cast<CurveClass>(k)}];
    }
    std::cout << "\n";
  }
  for (const auto& [curve_class, s] : statistics) {
    const auto letters = static_cast<Eigen::Index>(parameter_letters(curve_class).size());
    const Eigen::Index compared =
        pose_symmetry(curve_class) == 0 ? letters + 2 : letters + 3;  // a circle's theta is free
    std::cout << "  rmse/bound " << name_of(curve_class) << " (" << s.count << "):";
    for (Eigen::Index k = 0; k < compared; ++k) {
      const double ratio = std::sqrt(s.squares[k] / s.count);
      std::cout << " " << ratio;
      // 1 if maximum likelihood attains the bound; 0.1 for non-linearity where the bound is as
      // large as 3 %, and three standard deviations 1 / sqrt(2 n) of such a ratio.
      const double tolerance = 0.1 + 3.0 / std::sqrt(2.0 * s.count);
      EXPECT_LT(ratio, 1.0 + tolerance) << name_of(curve_class) << " component " << k;
      // Told nothing, what a probe may hide counts as well, and these probes hide nothing.
      if (told != Told::Nothing) {
        EXPECT_GT(ratio, 1.0 - tolerance) << name_of(curve_class) << " component " << k;
      }
    }
    std::cout << "\n";
  }
}

TEST(RecognitionScenes, WithTheNoiseStated) { run(Told::Noise); }

TEST(RecognitionScenes, WithTheNoiseUnknown) { run(Told::OnlyNoise); }

TEST(RecognitionScenes, WithTheProbeUnknown) { run(Told::Nothing); }

TEST(RecognitionScenes, CurvesOfNoClassAreNeverCertainlyOne) {
  // "Long enough": without noise the best class leaves a noncentrality of more than 60, twelve
  // standard deviations of a missing parameter.
  std::mt19937_64 rng = test::test_rng();
  int tellable = 0;
  int certainly_wrong = 0;
  for (const auto shape : {test::OutsideShape::Sinusoid, test::OutsideShape::Superellipse,
                           test::OutsideShape::LogSpiral, test::OutsideShape::Quartic}) {
    for (const double level : {1e-5, 1e-4, 1e-3, 2e-3}) {
      for (int patches = 1; patches <= 4; ++patches) {
        for (int i = 0; i < test::stress_count(8); ++i) {
          test::SceneOptions options;
          options.patches = patches;
          options.least_fraction = 0.15;
          options.most_fraction = 0.4;
          options.sigma_over_size = level;
          const std::mt19937_64 same = rng;
          const test::Scene scene = test::random_outside_scene(shape, options, rng);
          options.sigma_over_size = 0.0;
          std::mt19937_64 again = same;
          test::Scene exact = test::random_outside_scene(shape, options, again);
          const Recognition noiseless = test::recognise(exact, scene.sigma_m);
          double best = std::numeric_limits<double>::infinity();
          for (const Hypothesis& hypothesis : noiseless.hypotheses) {
            if (hypothesis.shape.curve_class != CurveClass::Unclassified) {
              best = std::min(best, hypothesis.chi2);
            }
          }
          if (!(best > 60.0)) {
            continue;
          }
          ++tellable;
          const Recognition answer = test::recognise(scene, scene.sigma_m);
          certainly_wrong += answer.status == RecognitionStatus::Recognized &&
                                     answer.shape.curve_class != CurveClass::Unclassified
                                 ? 1
                                 : 0;
        }
      }
    }
  }
  std::cout << "curves of no class: " << tellable << " long enough to tell, " << certainly_wrong
            << " certainly wrong\n";
  if (!test::counts_tell()) {
    return;
  }
  EXPECT_GT(tellable, 200);
  EXPECT_LT(100 * certainly_wrong, tellable);
}

}  // namespace
}  // namespace palpate
