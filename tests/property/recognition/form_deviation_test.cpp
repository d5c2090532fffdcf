// Ellipses with form error: how reliable RECOGNIZED answers are if the form error is stated, and if
// it is not.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iostream>

#include "core/numerics/probability/chi_square.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// Moves every sample along the ellipse's normal by a sum of harmonics of t with normal
/// coefficients. The standard deviation is `deviation_m` at every t, and all patches get the same
/// wave.
test::Scene with_form_error(test::Scene scene, double deviation_m, std::mt19937_64& rng) {
  constexpr int kLowest = 2;  // the first harmonic would be a shift
  constexpr int kHighest = 5;
  std::normal_distribution<double> normal(
      0.0, deviation_m / std::sqrt(static_cast<double>(kHighest - kLowest + 1)));
  std::vector<Vec2> coefficients;
  for (int k = kLowest; k <= kHighest; ++k) {
    const double cosine = normal(rng);
    coefficients.emplace_back(cosine, normal(rng));
  }
  for (std::size_t p = 0; p < scene.patches.size(); ++p) {
    for (std::size_t i = 0; i < scene.patches[p].size(); ++i) {
      const double t = scene.t[p][i];
      double error_m = 0.0;
      for (int k = kLowest; k <= kHighest; ++k) {
        error_m += coefficients[static_cast<std::size_t>(k - kLowest)].dot(
            Vec2(std::cos(k * t), std::sin(k * t)));
      }
      const Vec2 outward(scene.values[1] * std::cos(t), scene.values[0] * std::sin(t));
      scene.patches[p][i] += scene.world_T_curve.rotate(error_m * outward.normalized());
    }
  }
  return scene;
}

/// e^T C^-1 e of shape and pose.
double squared_distance(const Recognition& answer, const test::Scene& scene) {
  const Eigen::VectorXd error = test::error_of(answer.hypotheses.front(), scene);
  const Eigen::VectorXd scale = answer.covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd correlation = scale.asDiagonal() * answer.covariance * scale.asDiagonal();
  const Eigen::VectorXd scaled = scale.cwiseProduct(error);
  return scaled.dot(correlation.ldlt().solve(scaled));
}

struct Count {
  int scenes = 0;
  int recognized = 0;
  int wrong = 0;         ///< of the recognised ones
  int ellipses = 0;      ///< of the recognised ones
  int beyond = 0;        ///< of the ellipses: the truth is outside the 95 % ellipsoid
  double squares = 0.0;  ///< normalised squared errors of the ellipses
  Count& operator+=(const Count& other) {
    scenes += other.scenes;
    recognized += other.recognized;
    wrong += other.wrong;
    ellipses += other.ellipses;
    beyond += other.beyond;
    squares += other.squares;
    return *this;
  }
};

constexpr int kDof = 5;

/// Wrong are: another class, except a circle if the axes of the ellipse differ by less than 15 %;
/// and an axis off by more than a tenth without a covariance that says so.
void add(const Recognition& answer, const test::Scene& scene, Count* count) {
  constexpr double kWrongAxis = 0.1;
  constexpr double kNearCircle = 0.15;
  ++count->scenes;
  if (answer.status != RecognitionStatus::Recognized) {
    return;
  }
  ++count->recognized;
  if (answer.shape.curve_class != CurveClass::Ellipse) {
    const double departure = 1.0 - scene.values[1] / scene.values[0];
    const bool near_circle =
        answer.shape.curve_class == CurveClass::Circle && departure <= kNearCircle;
    count->wrong += near_circle ? 0 : 1;
    return;
  }
  const double a = std::abs(answer.shape.values[0] / scene.values[0] - 1.0);
  const double b = std::abs(answer.shape.values[1] / scene.values[1] - 1.0);
  const double square = squared_distance(answer, scene);
  const bool beyond = square > chi_square_threshold(0.05, kDof);
  ++count->ellipses;
  count->squares += square;
  count->beyond += beyond ? 1 : 0;
  count->wrong += beyond && std::max(a, b) > kWrongAxis ? 1 : 0;
}

void print(const Count& count) {
  std::cout << "\t" << count.recognized << " of " << count.scenes << "\t" << count.wrong << "\t";
  if (count.ellipses > 0) {
    std::cout << count.squares / count.ellipses;
  }
  std::cout << "\t" << count.beyond << " |";
}

struct Setting {
  const char* name;
  double sigma_over_size;
  double deviation_over_size;
};

constexpr Setting kSettings[] = {
    {"noise above form", 3e-3, 1e-3},
    {"as large", 5e-4, 5e-4},
    {"form above noise", 2e-5, 2e-4},
};

TEST(FormDeviation, StatedItMakesRecognizedAnswersRight) {
  std::mt19937_64 rng = test::test_rng();
  // Of shorter arcs such deviations leave neither an ellipse nor a spline's arc the only one.
  constexpr int kLongArc = 120;
  Count all_stated;
  Count all_unstated;
  Count long_stated;
  std::cout
      << "ellipse arcs with form error; RECOGNIZED, wrong, mean normalised squared error (law: "
      << kDof << "), beyond the 95 % ellipsoid of it; stated | not stated\n";
  for (const Setting& setting : kSettings) {
    for (const bool noise_told : {true, false}) {
      for (const int degrees : {60, 90, 120, 180, 270}) {
        Count stated;
        Count unstated;
        for (int i = 0; i < test::stress_count(60); ++i) {
          test::SceneOptions how;
          how.patches = 1 + i % 2;
          how.sigma_over_size = setting.sigma_over_size;
          test::Scene scene = test::random_ellipse_arc(degrees * kPi / 180.0, how, rng);
          RecognizerOptions options;
          options.form_deviation_m = setting.deviation_over_size * how.size_m;
          scene = with_form_error(std::move(scene), options.form_deviation_m, rng);
          const double sigma_m = noise_told ? scene.sigma_m : 0.0;
          add(test::recognise(scene, sigma_m, options), scene, &stated);
          add(test::recognise(scene, sigma_m), scene, &unstated);
        }
        std::cout << "  " << setting.name << (noise_told ? ", told\t" : ", not told\t") << degrees;
        print(stated);
        print(unstated);
        std::cout << "\n";
        all_stated += stated;
        if (degrees >= kLongArc) {
          long_stated += stated;
        }
        all_unstated += unstated;
      }
    }
  }
  std::cout << "  all\t";
  print(all_stated);
  print(all_unstated);
  std::cout << "\n";
  if (!test::counts_tell()) {
    return;
  }
  // With stated form error few answers are wrong, and covariances are no smaller than the errors...
  EXPECT_LT(100 * all_stated.wrong, all_stated.recognized);
  EXPECT_LE(all_stated.squares, kDof * all_stated.ellipses);
  EXPECT_LE(all_stated.beyond, 0.05 * all_stated.ellipses);
  // ... though two in three long arcs are still recognised,
  EXPECT_GT(3 * long_stated.recognized, 2 * long_stated.scenes);
  // and these scenes are not harmless.
  EXPECT_GT(100 * all_unstated.wrong, all_unstated.recognized);
  EXPECT_GT(all_unstated.squares, kDof * all_unstated.ellipses);
}

class FormDeviationOf : public testing::TestWithParam<CurveClass> {};

test::Scene two_patches(CurveClass curve_class, std::mt19937_64& rng) {
  test::SceneOptions how;
  how.sigma_over_size = 2e-4;
  how.least_fraction = 0.2;
  how.most_fraction = 0.45;
  return test::random_scene(curve_class, how, rng);
}

double samples_of(const test::Scene& scene) {
  double count = 0.0;
  for (const auto& patch : scene.patches) {
    count += static_cast<double>(patch.size());
  }
  return count;
}

/// Rivals are searched for on a grid and on reduced points that depend on the noise, so
/// probabilities agree only to this. A decision is compared unless it depends on such a difference.
constexpr double kProbability = 0.03;

void expect_same_certainty(const Recognition& answer, const Recognition& expected) {
  const double probability = expected.hypotheses.front().probability;
  EXPECT_NEAR(answer.hypotheses.front().probability, probability, kProbability);
  if (std::abs(probability - RecognizerOptions{}.recognized_probability) > kProbability) {
    EXPECT_EQ(answer.status, expected.status);
  }
}

/// Compares the covariances of the pose, whose last component is an angle, up to a factor of
/// lengths.
void expect_same_covariance(const Recognition& answer, const Recognition& expected, double factor,
                            double tolerance) {
  ASSERT_EQ(answer.covariance.rows(), expected.covariance.rows());
  for (Eigen::Index k = 1; k <= std::min<Eigen::Index>(3, expected.covariance.rows()); ++k) {
    const Eigen::Index i = expected.covariance.rows() - k;
    const double variance = (k == 1 ? 1.0 : factor * factor) * expected.covariance(i, i);
    EXPECT_NEAR(answer.covariance(i, i), variance, tolerance * variance);
  }
}

TEST_P(FormDeviationOf, NextToNothingChangesNextToNothing) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < 5; ++i) {
    const test::Scene scene = two_patches(GetParam(), rng);
    for (const double sigma_m : {scene.sigma_m, 0.0}) {
      RecognizerOptions options;
      constexpr double kShare = 1e-8;  // of the noise's variance, in any combination of residuals
      options.form_deviation_m = scene.sigma_m * std::sqrt(kShare / samples_of(scene));
      const Recognition exact = test::recognise(scene, sigma_m);
      const Recognition stated = test::recognise(scene, sigma_m, options);
      ASSERT_EQ(stated.shape.curve_class, exact.shape.curve_class);
      EXPECT_EQ(stated.status, exact.status);
      EXPECT_NEAR(stated.hypotheses.front().probability, exact.hypotheses.front().probability,
                  1e-5);
      EXPECT_NEAR(stated.sigma_m, exact.sigma_m, 1e-6 * exact.sigma_m);
      expect_same_covariance(stated, exact, 1.0, 1e-6);
    }
  }
}

TEST_P(FormDeviationOf, SaysWhatWhiteNoiseOfTheBoundWouldSay) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < 5; ++i) {
    const test::Scene scene = two_patches(GetParam(), rng);
    for (const double deviations : {0.3, 3.0}) {
      const double n = samples_of(scene);
      RecognizerOptions options;
      options.form_deviation_m = deviations * scene.sigma_m / std::sqrt(n);
      const Recognition stated = test::recognise(scene, scene.sigma_m, options);
      const Recognition white = test::recognise(scene, scene.sigma_m * std::hypot(1.0, deviations));
      ASSERT_EQ(stated.shape.curve_class, white.shape.curve_class);
      EXPECT_NEAR(stated.hypotheses.front().probability, white.hypotheses.front().probability,
                  kProbability);
      // The smooth model does not follow a sharp bend to within the noise; that is not a misfit of
      // the class.
      EXPECT_EQ(stated.doubt == Doubt::Misfit, white.doubt == Doubt::Misfit);
      if (white.status == RecognitionStatus::Recognized && stated.status == white.status) {
        // Slices of a valley are computed on the reduced points, whose degrees depend on the noise.
        // If two coordinates are nearly equally wide, they may run along either; so deviations
        // agree to 5 %.
        expect_same_covariance(stated, white, 1.0, 0.1);
      }
    }
  }
}

TEST_P(FormDeviationOf, ScalesWithThePart) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < 5; ++i) {
    const test::Scene scene = two_patches(GetParam(), rng);
    RecognizerOptions options;
    options.form_deviation_m = 0.3 * scene.sigma_m;
    const Recognition answer = test::recognise(scene, scene.sigma_m, options);
    for (const double factor : {1e-3, 1e3}) {
      test::Scene large = scene;
      for (auto& patch : large.patches) {
        for (Vec2& p : patch) {
          p *= factor;
        }
      }
      RecognizerOptions for_large;
      for_large.form_deviation_m = factor * options.form_deviation_m;
      const Recognition scaled = test::recognise(large, factor * scene.sigma_m, for_large);
      ASSERT_EQ(scaled.shape.curve_class, answer.shape.curve_class);
      expect_same_certainty(scaled, answer);
      EXPECT_NEAR(scaled.sigma_m, factor * answer.sigma_m, 1e-6 * factor * answer.sigma_m);
      expect_same_covariance(scaled, answer, factor, 0.01);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllClasses, FormDeviationOf, testing::ValuesIn(kCurveClasses),
                         [](const auto& test) { return std::string(name_of(test.param)); });

}  // namespace
}  // namespace palpate
