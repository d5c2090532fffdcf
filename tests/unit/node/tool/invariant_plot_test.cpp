// The picture of the tree's invariants: what each contact alone says agrees with what all say.
#include "node/tool/drawing/svg/invariant_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "node/tool/drawing/invariant_points.h"
#include "tests/support/scene_data.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

Recognition tree_answer(CurveClass curve_class, std::mt19937_64& rng) {
  test::SceneOptions options;
  options.patches = 3;
  options.points_per_patch = 200;
  options.sigma_over_size = 1e-8;
  const test::Scene scene = test::random_scene(curve_class, options, rng);
  RecognizerOptions recognizer;
  recognizer.method = RecognitionMethod::Tree;
  return test::recognise(scene, scene.sigma_m, recognizer);
}

/// The panel and its line that are of the class; nullptr where the picture has none.
const PooledLine* line_of(const InvariantPanel& panel, CurveClass curve_class) {
  const bool central = curve_class == CurveClass::Ellipse || curve_class == CurveClass::Hyperbola;
  if (!panel.x_is_contact) {
    for (const PooledLine& line : panel.lines) {
      if (central && line.label.starts_with("Ic1")) return &line;
      if (curve_class == CurveClass::Parabola && line.label.starts_with("Ip")) return &line;
    }
    return nullptr;
  }
  const std::string_view name = curve_class == CurveClass::Circle                ? "kappa"
                                : curve_class == CurveClass::CubicalParabola     ? "Icp"
                                : curve_class == CurveClass::SemiCubicalParabola ? "Iscp"
                                : curve_class == CurveClass::CubicSpline         ? "c "
                                                                                 : "none";
  return panel.title.starts_with(name) ? &panel.lines.front() : nullptr;
}

TEST(InvariantPanels, OfTheTrueClassEveryContactAgreesWithThePooledValue) {
  std::mt19937_64 rng = test::test_rng();
  for (const CurveClass curve_class : kCurveClasses) {
    if (curve_class == CurveClass::Line) {
      continue;  // has none
    }
    int points = 0;
    int within = 0;
    for (int i = 0; i < 10; ++i) {
      const Recognition answer = tree_answer(curve_class, rng);
      if (answer.tree_class != curve_class) {
        continue;
      }
      for (const InvariantPanel& panel : invariant_panels(answer)) {
        const PooledLine* line = line_of(panel, curve_class);
        if (line == nullptr) {
          continue;
        }
        EXPECT_EQ(panel.points.size(), answer.contacts.size());
        for (const InvariantPoint& point : panel.points) {
          const double sigma =
              std::hypot(point.y_sigma, line->slope * point.x_sigma, line->sigma_at(point.x));
          // Where a contact's value is vague it is not linear in its errors (far out on a spline,
          // c goes as the root of a difference): the bars promise nothing there.
          constexpr double kMostRelativeError = 0.03;
          if (!(point.y_sigma <= kMostRelativeError * std::abs(point.y))) {
            continue;
          }
          constexpr double kDeviations = 4.0;
          ++points;
          within += std::abs(point.y - line->at(point.x)) <= kDeviations * sigma ? 1 : 0;
        }
      }
    }
    // A normal law leaves 4 deviations once in 10^4, the estimates' own deviations beside bends
    // once in a hundred, and kappa and kappa_s of one contact go together.
    EXPECT_GT(points, 10) << name_of(curve_class);
    EXPECT_GE(within, 0.95 * points) << name_of(curve_class);
  }
}

TEST(InvariantPanels, ConicsAreOnePanelWithTheirBand) {
  std::mt19937_64 rng = test::test_rng();
  const Recognition answer = tree_answer(CurveClass::Ellipse, rng);
  int conics = 0;
  for (const InvariantPanel& panel : invariant_panels(answer)) {
    if (panel.x_is_contact) {
      continue;
    }
    ++conics;
    ASSERT_GE(panel.lines.size(), 1U);
    EXPECT_THAT(panel.lines.front().label, StartsWith("Ic1"));
    // Ic1 and Ic2 go together: among the contacts the line is known better than its intercept is.
    const PooledLine& line = panel.lines.front();
    EXPECT_LT(line.sigma_at(panel.points.front().x), std::sqrt(line.covariance(0, 0)));
  }
  EXPECT_EQ(conics, 1);
}

TEST(InvariantPlot, IsADocumentWithAPanelAnInvariant) {
  std::mt19937_64 rng = test::test_rng();
  const Recognition answer = tree_answer(CurveClass::CubicalParabola, rng);
  const std::string svg = invariant_plot(answer, "a<b>.csv");
  EXPECT_THAT(svg, StartsWith("<svg "));
  EXPECT_THAT(svg, HasSubstr("a&lt;b&gt;.csv"));
  EXPECT_THAT(svg, HasSubstr("Icp1 of the cubical parabola"));
  EXPECT_THAT(svg, HasSubstr("</svg>"));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(InvariantPlot, WithoutContactsSaysSo) {
  EXPECT_THAT(invariant_plot(Recognition(), "none"), HasSubstr("too few contacts"));
}

}  // namespace
}  // namespace palpate
