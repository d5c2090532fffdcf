#include "core/recognition/smooth/smooth_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/smooth/turning_sections.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"
#include "tests/support/unbounded_work.h"

namespace palpate {
namespace {

test::Scene scene_of(CurveClass curve_class, std::mt19937_64& rng) {
  test::SceneOptions options;
  options.patches = 2;
  return test::random_scene(curve_class, options, rng);
}

TEST(SmoothModel, LeavesNoiseAloneWhateverTheClass) {
  std::mt19937_64 rng = test::test_rng();
  double chi2 = 0.0;
  double dof = 0.0;
  for (const CurveClass curve_class : kCurveClasses) {
    for (int i = 0; i < 20; ++i) {
      const test::Scene scene = scene_of(curve_class, rng);
      FitData data = test::fit_data(scene, scene.sigma_m);
      const SmoothModel model = fit_smooth_model(&data, true);
      EXPECT_LT(model.reduced.points.size(), data.points.size() / 3);
      chi2 += model.chi2;
      dof += model.dof();
    }
  }
  // Choosing the degree by the data takes a little more than its parameters' share of the noise:
  // within 3 % of one per degree of freedom over the 160 scenes.
  EXPECT_NEAR(chi2 / dof, 1.0, 0.03);
}

TEST(SmoothModel, ReducedPointsTellWhatAllPointsTell) {
  // chi2 of a class on all points = chi2 of the smooth model + chi2 on the reduced points. Fits of
  // the true class differ by what two more degrees of each section's polynomial hold of noise.
  std::mt19937_64 rng = test::test_rng();
  for (const CurveClass curve_class : kCurveClasses) {
    for (int i = 0; i < 10; ++i) {
      const test::Scene scene = scene_of(curve_class, rng);
      FitData data = test::fit_data(scene, scene.sigma_m);
      const SmoothModel model = fit_smooth_model(&data, true);
      const ClassFits fits = fit_classes(model.reduced, test::unbounded_work());
      const auto& fit = fits[static_cast<std::size_t>(curve_class)];
      ASSERT_TRUE(fit.has_value());
      if (fit->at_limit) {
        continue;
      }
      const auto refined =
          refine_on_all(settled(*fit, model.reduced, RivalOf::Best, test::unbounded_work()), model,
                        data, kOnAllEffort, test::unbounded_work());
      if (!refined) {
        continue;  // straight points: no such conic
      }
      EXPECT_NEAR(refined->chi2, fit->chi2 + model.chi2, 1.0 + 0.02 * model.chi2)
          << name_of(curve_class);
    }
  }
}

TEST(SmoothModel, TangentsFollowTravel) {
  std::mt19937_64 rng = test::test_rng();
  const test::Scene scene = scene_of(CurveClass::Ellipse, rng);
  FitData data = test::fit_data(scene, scene.sigma_m);
  fit_smooth_model(&data, true);
  for (const PatchSpan& patch : data.patches) {
    for (std::size_t i = patch.begin + 5; i + 5 < patch.end; ++i) {
      const Vec2 chord = data.points[i + 5].position - data.points[i - 5].position;
      EXPECT_GT(data.points[i].tangent.dot(chord.normalized()), 0.9);
    }
  }
}

/// One patch of samples along an arc of the unit circle, noise in both coordinates.
FitData circular_arc(double turn, std::size_t count, double sigma, std::mt19937_64& rng) {
  std::normal_distribution<double> noise(0.0, sigma);
  FitData data;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = turn * static_cast<double>(i) / static_cast<double>(count);
    FitPoint point;
    const double dx = noise(rng);
    point.position = {std::cos(t) + dx, std::sin(t) + noise(rng)};
    point.inverse_sigma = 1.0 / sigma;
    data.points.push_back(point);
  }
  data.patches.push_back({0, count});
  return data;
}

TEST(SmoothModel, NoiseCutsNoPatch) {
  std::mt19937_64 rng = test::test_rng();
  for (int i = 0; i < 50; ++i) {
    // No longer than its noise: its chords lead anywhere.
    const FitData cloud = circular_arc(0.01, 1000, 0.01, rng);
    EXPECT_EQ(sections_of(cloud, cloud.patches.front(), false).size(), 1U);
    // Samples that stay at a place show no noise, but it is stated.
    FitData dwelling = cloud;
    for (std::size_t k = 0; k < dwelling.points.size(); ++k) {
      dwelling.points[k].position = cloud.points[k - k % 8].position;
    }
    EXPECT_LT(2 * sections_of(dwelling, dwelling.patches.front(), true).size(),
              sections_of(dwelling, dwelling.patches.front(), false).size());
    // All the way round is cut about every radian, however large the noise.
    for (const double sigma : {1e-6, 0.01, 0.1}) {
      const FitData circle = circular_arc(6.28, 1000, sigma, rng);
      const auto sections = sections_of(circle, circle.patches.front(), true);
      EXPECT_GE(sections.size(), 4U) << sigma;
      EXPECT_LE(sections.size(), 7U) << sigma;
    }
  }
}

TEST(SmoothModel, NoSectionLeadsRoundACusp) {
  std::mt19937_64 rng = test::test_rng();
  constexpr double kSigma = 5e-4;
  std::normal_distribution<double> noise(0.0, kSigma);
  for (int i = 0; i < 50; ++i) {
    FitData data;
    data.scale = 1.0;
    // y^2 = x^3, the cusp anywhere between two samples, or near an end.
    const double begin = i % 2 == 0 ? -1.0 : -0.2;
    constexpr std::size_t kCount = 101;
    const double shift = test::uniform(rng, 0.0, 1.0);
    for (std::size_t k = 0; k < kCount; ++k) {
      const double t = begin + (1.0 - begin) * (static_cast<double>(k) + shift) / kCount;
      FitPoint point;
      const double dx = noise(rng);
      point.position = {t * t + dx, t * t * t + noise(rng)};
      point.inverse_sigma = 1.0 / kSigma;
      data.points.push_back(point);
    }
    data.patches.push_back({0, kCount});
    // The reduced points say of the curve what its samples do: chi-square of the samples is that of
    // the smooth model and of the reduced points, which is what the model absorbed.
    const SmoothModel smooth = fit_smooth_model(&data, true);
    const auto chi2_of = [](const std::vector<FitPoint>& points) {
      double chi2 = 0.0;
      for (const FitPoint& point : points) {
        PolynomialCoefficients curve = PolynomialCoefficients::Zero();
        curve(0, 2) = curve(1, 3) = 1.0;
        const double t = nearest_parameter(curve, point.position);
        const double r = (point.position - position_at(curve, t)).norm() * point.inverse_sigma;
        chi2 += r * r;
      }
      return chi2;
    };
    // A term that a section leaves out adds less than the logarithm of its samples (BIC).
    double most = 0.0;
    for (const ReducedSection& section : smooth.sections) {
      most += section.kept ? 0.0 : std::log(static_cast<double>(kCount));
    }
    EXPECT_NEAR(chi2_of(smooth.reduced.points) + smooth.chi2, chi2_of(data.points), most) << i;
  }
}

// Six strokes from one side of an ellipse round its end to the other, every 20 degrees. A parabola
// over the chord leaves a tenth of its size, which no noise of a probe is.
TEST(SmoothModel, NoPolynomialTellsTheNoiseOfSamplesThatAreNoGraph) {
  std::mt19937_64 rng = test::test_rng();
  std::normal_distribution<double> noise(0.0, 1e-4);
  for (int i = 0; i < 50; ++i) {
    FitData data;
    data.noise_is_stated = false;
    for (int stroke = 0; stroke < 6; ++stroke) {
      const std::size_t begin = data.points.size();
      const double first = -1.5 + test::uniform(rng, -0.1, 0.1);
      for (int k = 0; k < 10; ++k) {
        const double t = first + 0.35 * k;
        FitPoint point;
        const double dx = noise(rng);
        point.position = {std::cos(t) + dx, 0.3 * std::sin(t) + noise(rng)};
        data.points.push_back(point);
      }
      data.patches.push_back({begin, data.points.size()});
    }
    const SmoothModel smooth = fit_smooth_model(&data, false);
    EXPECT_EQ(smooth.reduced.points.size(), data.points.size()) << i;
    EXPECT_EQ(smooth.dof(), 0) << i;
  }
}

// A section of ten samples leaves five degrees of freedom, by which nobody can say whether it
// leaves noise or form. Where several leave enough, they show it.
TEST(SmoothModel, AFewDegreesShowNoNoise) {
  std::mt19937_64 rng = test::test_rng();
  for (const std::size_t strokes : {2U, 12U}) {
    FitData data;
    data.noise_is_stated = false;
    for (std::size_t stroke = 0; stroke < strokes; ++stroke) {
      const FitData arc = circular_arc(0.3, 10, 1e-3, rng);
      data.patches.push_back({data.points.size(), data.points.size() + arc.points.size()});
      data.points.insert(data.points.end(), arc.points.begin(), arc.points.end());
    }
    const SmoothModel smooth = fit_smooth_model(&data, false);
    EXPECT_EQ(smooth.dof() >= kDegreesThatShowNoise, strokes > 2) << smooth.dof();
    EXPECT_EQ(smooth.dof() == 0, strokes == 2) << smooth.dof();
  }
}

TEST(SmoothModel, NoiseThatIsStatedTooLowIsNotFollowed) {
  std::mt19937_64 rng = test::test_rng();
  constexpr double kTooLow = 1e-3;
  std::size_t points_by_honest = 0;
  std::size_t points_by_bold = 0;
  for (int i = 0; i < 50; ++i) {
    FitData honest = circular_arc(1.5, 400, 1e-4, rng);
    FitData bold = honest;
    for (FitPoint& point : bold.points) {
      point.inverse_sigma /= kTooLow;
    }
    const SmoothModel by_honest = fit_smooth_model(&honest, true);
    const SmoothModel by_bold = fit_smooth_model(&bold, true);
    points_by_honest += by_honest.reduced.points.size();
    points_by_bold += by_bold.reduced.points.size();
    EXPECT_NEAR(by_bold.noise_ratio() * kTooLow, by_honest.noise_ratio(), 0.05);
  }
  // The quietest sections tell less noise than there is, and the criterion then takes some degrees
  // more; followed to what is stated it were ten times as many points.
  std::cout << points_by_bold << " reduced points for " << points_by_honest << '\n';
  EXPECT_LE(2 * points_by_bold, 3 * points_by_honest);
}

}  // namespace
}  // namespace palpate
