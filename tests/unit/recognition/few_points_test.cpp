#include "core/recognition/fit/few_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "core/recognition/fit/class_fits.h"

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

TEST(FewPoints, LeadToTheCurveOfAll) {
  const FitData all = around_a_circle(8, 40);
  const ClassFits fits = fit_classes(all);
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
