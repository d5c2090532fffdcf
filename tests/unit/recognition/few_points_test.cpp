#include "core/recognition/fit/starts/few_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/recognition/fit/class_fits.h"
#include "tests/support/unbounded_work.h"

namespace palpate {
namespace {

/// Patches of `each` points side by side along a circle.
FitData around_a_circle(std::size_t patches, std::size_t each) {
  FitData data;
  const double step = 2.0 * kPi / static_cast<double>(patches * each);
  for (std::size_t p = 0; p < patches; ++p) {
    const std::size_t begin = data.points.size();
    for (std::size_t i = 0; i < each; ++i) {
      const double angle = step * static_cast<double>(begin + i);
      FitPoint point;
      point.position = {std::cos(angle), std::sin(angle)};
      point.tangent = left_of(point.position);
      point.inverse_sigma = 1e4;
      data.points.push_back(point);
    }
    data.patches.push_back({begin, data.points.size()});
  }
  return data;
}

TEST(FewPoints, AreAskedForWhereThereAreMany) {
  EXPECT_FALSE(few_of(around_a_circle(4, 32)));
  EXPECT_TRUE(few_of(around_a_circle(4, 33)));
}

TEST(FewPoints, AreBoundedInNumberAndKeepPatchesAndTheirOrder) {
  for (const std::size_t patches : {1U, 5U, 16U, 54U, 300U}) {
    const FitData all = around_a_circle(patches, 1200 / patches);
    const auto few = few_of(all);
    ASSERT_TRUE(few);
    EXPECT_GE(few->points.size(), 48U) << patches;
    EXPECT_LE(few->points.size(), 68U) << patches;
    std::size_t next = 0;
    for (const PatchSpan& patch : few->patches) {
      EXPECT_EQ(patch.begin, next);
      EXPECT_GE(patch.size(), 4U);
      next = patch.end;
    }
    EXPECT_EQ(next, few->points.size());
    std::size_t at = 0;
    for (const FitPoint& point : few->points) {
      while (at < all.points.size() && all.points[at].position != point.position) {
        ++at;
      }
      ASSERT_LT(at, all.points.size()) << "none of all, or not in their order";
    }
  }
}

TEST(FewPoints, AreJoinedByAsManyThatAreMissedMost) {
  const FitData all = around_a_circle(5, 240);
  const FitData few = *few_of(all);
  std::vector<double> squares(all.points.size(), 0.0);
  std::vector<Vec2> missed;
  for (std::size_t i = 700; i < 720; ++i) {
    squares[i] = 1.0;
    missed.push_back(all.points[i].position);
  }
  const FitData more = few_and_worst_fitted(all, squares);
  EXPECT_EQ(more.points.size(), few.points.size() + 64);
  const auto has = [&](const Vec2& place) {
    return std::any_of(more.points.begin(), more.points.end(),
                       [&](const FitPoint& point) { return point.position == place; });
  };
  for (const FitPoint& point : few.points) {
    EXPECT_TRUE(has(point.position));
  }
  for (const Vec2& place : missed) {
    EXPECT_TRUE(has(place));
  }
}

/// The exact points of a spline whose arms lie beside one another next to a sharp bend, as seen by
/// noise that none of them has.
FitData along_a_sharp_spline(std::size_t points) {
  FitData data;
  for (std::size_t i = 0; i < points; ++i) {
    const double t = 2.0 * static_cast<double>(i) / static_cast<double>(points - 1) - 1.0;
    FitPoint point;
    point.position = {2.0 * t * t - 1.0, 0.8 * t * t * t + 0.05 * t * t + 1e-3 * t};
    point.tangent = Vec2(4.0 * t, 2.4 * t * t + 0.1 * t + 1e-3).normalized();
    point.inverse_sigma = 1e9;
    data.points.push_back(point);
  }
  data.patches.push_back({0, points});
  return data;
}

TEST(FewPoints, LeadToBothArmsOfASharpBend) {
  const FitData all = along_a_sharp_spline(600);
  const ClassFits fits = fit_classes(all, test::unbounded_work());
  const auto& spline = fits[static_cast<std::size_t>(CurveClass::CubicSpline)];
  ASSERT_TRUE(spline);
  EXPECT_TRUE(fits_well(spline->chi2, all.points.size())) << spline->chi2;
}

TEST(FewPoints, OfNoClassAreOnlyPlacedOnAll) {
  // Five petals: no class comes near.
  FitData all;
  for (int i = 0; i < 500; ++i) {
    const double angle = 2.0 * kPi * i / 500;
    FitPoint point;
    point.position = (0.7 + 0.3 * std::cos(5.0 * angle)) * Vec2(std::cos(angle), std::sin(angle));
    point.inverse_sigma = 1e4;
    all.points.push_back(point);
  }
  all.patches.push_back({0, all.points.size()});
  const ClassFits fits = fit_classes(all, test::unbounded_work());
  for (const auto& fit : fits) {
    if (!fit) {
      continue;
    }
    EXPECT_GT(fit->chi2, most_chi2_of_noise(all.points));
    const std::size_t feet = fit->implicit ? fit->implicit->feet.size() : fit->polynomial->t.size();
    EXPECT_EQ(feet, all.points.size());
  }
}

TEST(FewPoints, LeadToTheCurveOfAll) {
  const FitData all = around_a_circle(8, 40);
  const ClassFits fits = fit_classes(all, test::unbounded_work());
  const auto& circle = fits[static_cast<std::size_t>(CurveClass::Circle)];
  ASSERT_TRUE(circle);
  EXPECT_LT(circle->chi2, 1e-6);
  EXPECT_EQ(circle->implicit->feet.size(), all.points.size());
  const auto& spline = fits[static_cast<std::size_t>(CurveClass::CubicSpline)];
  ASSERT_TRUE(spline && spline->polynomial);
  EXPECT_EQ(spline->polynomial->t.size(), all.points.size());
}

}  // namespace
}  // namespace palpate
