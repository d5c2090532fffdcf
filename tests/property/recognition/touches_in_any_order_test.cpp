// Touches of curves whose arms lie close together, in one order and in others.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "tests/support/answered_touches.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kCurveExtent = 0.025;              // half of it [m]
constexpr double kFineSigma = 1e-6 * kCurveExtent;  // [m]
constexpr int kTouches = 30;

using Along = std::function<double(int, std::mt19937_64&)>;

/// Anywhere from end to end.
double all_along(int /*touch*/, std::mt19937_64& rng) { return test::uniform(rng, -1.0, 1.0); }

/// About two places, of which each arm has one.
double in_two_clusters(int touch, std::mt19937_64& rng) {
  return (touch % 2 == 0 ? -1.0 : 1.0) * test::uniform(rng, 0.4, 0.9);
}

std::vector<Vec2> touched_along(CurveClass truth, const Along& along, std::mt19937_64& rng) {
  const double bend = test::uniform(rng, 0.5, 1.0);
  const double slope = test::uniform(rng, -0.3, 0.3);
  const Pose2 pose = test::pose_within(rng, 0.5);
  std::vector<Vec2> touches;
  for (int i = 0; i < kTouches; ++i) {
    const double t = along(i, rng);
    const double x = truth == CurveClass::CubicalParabola ? t : t * t;
    const double y = bend * t * t * t + slope * x;
    touches.push_back(pose * Vec2(kCurveExtent * x, kCurveExtent * y) +
                      test::normal_pair(rng, kFineSigma));
  }
  return touches;
}

/// Each order of the rows is of the class that was touched. Its noise is a millionth of its size,
/// so that no simpler class fits; but a spline may, where the cusp is far from all touches. Then
/// every order says so.
void expect_in_any_order(CurveClass truth, const Along& along, std::uint64_t part) {
  constexpr int kOrders = 10;
  std::mt19937_64 rng = test::test_rng(part);
  std::vector<Vec2> touches = touched_along(truth, along, rng);
  const Recognition first = test::answer_to_touches(touches, kFineSigma);
  EXPECT_TRUE(first.status == RecognitionStatus::Recognized ||
              (truth == CurveClass::SemiCubicalParabola && first.doubt == Doubt::SeveralClasses))
      << "part " << part << ": " << test::said(first);
  for (int order = 0; order < kOrders; ++order) {
    const Recognition answer = test::answer_to_touches(touches, kFineSigma);
    EXPECT_TRUE(answer.status == first.status && answer.shape.curve_class == truth)
        << "part " << part << ", order " << order << ": " << test::said(answer);
    std::shuffle(touches.begin(), touches.end(), rng);
  }
}

void expect_parts_in_any_order(CurveClass truth, const Along& along) {
  const int parts = test::stress_count(30);
  for (int part = 0; part < parts; ++part) {
    expect_in_any_order(truth, along, static_cast<std::uint64_t>(part));
  }
}

TEST(TouchesInAnyOrder, AllAlongACubicalParabolaAreOfIt) {
  expect_parts_in_any_order(CurveClass::CubicalParabola, all_along);
}

TEST(TouchesInAnyOrder, InTwoClustersOfACubicalParabolaAreOfIt) {
  expect_parts_in_any_order(CurveClass::CubicalParabola, in_two_clusters);
}

/// Parts whose cusp's arms were so close together that a fit was followed on the wrong one: every
/// order, or nearly every one, was of a spline for certain.
TEST(TouchesInAnyOrder, AllAlongASemiCubicalParabolaThatWasLostAreOfIt) {
  for (const std::uint64_t part : {11, 38, 46, 54, 67, 68, 77, 86, 94}) {
    expect_in_any_order(CurveClass::SemiCubicalParabola, all_along, part);
  }
}

TEST(TouchesInAnyOrder, InTwoClustersOfASemiCubicalParabolaAreOfIt) {
  expect_parts_in_any_order(CurveClass::SemiCubicalParabola, in_two_clusters);
}

}  // namespace
}  // namespace palpate
