// Joints, foot points and canonical segments of the closed spline.
#include "core/part/closed_spline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/closed_spline_part.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

TEST(ClosedSpline, SegmentsMeetWithTwoDerivativesAndTheThirdJumps) {
  const ClosedSpline part = test::paper_part();
  ASSERT_EQ(part.size(), 5U);
  for (std::size_t i = 0; i < part.size(); ++i) {
    const CurveDerivatives end = part.segment(i).derivatives(1.0);
    const CurveDerivatives begin = part.segment(i + 1).derivatives(0.0);
    EXPECT_LT((end.position - begin.position).norm(), 1e-16);
    EXPECT_LT((end.first - begin.first).norm(), 1e-16);
    EXPECT_LT((end.second - begin.second).norm(), 1e-15);
    EXPECT_GT((end.third - begin.third).norm(), 1e-3);
  }
}

TEST(ClosedSpline, AnyParameterIsTakenModuloThePeriod) {
  const ClosedSpline part = test::paper_part();
  for (const double t : {0.0, 0.25, 3.999, 4.5}) {
    for (const double turns : {-10.0, -5.0, 5.0, 50.0}) {
      EXPECT_LT((part.position(t) - part.position(t + turns)).norm(), 1e-15);
    }
  }
  // Just below the seam: the end of the last segment or the beginning of the first, which are one.
  EXPECT_LT((part.position(-1e-17) - part.position(0.0)).norm(), 1e-15);
  EXPECT_LT((part.position(-1e-12) - part.position(0.0)).norm(), 1e-12);
  EXPECT_EQ(part.segment_at(-1e-12), 4U);
  EXPECT_EQ(part.segment_at(5.0), 0U);
  EXPECT_EQ(part.segment_at(std::nextafter(5.0, 0.0)), 4U);
}

TEST(ClosedSpline, FootPointIsTheNearestOfAll) {
  const ClosedSpline part = test::paper_part();
  auto rng = test::test_rng();
  std::uniform_real_distribution<double> uniform(-0.06, 0.06);
  for (int i = 0; i < test::stress_count(300); ++i) {
    const Vec2 point(uniform(rng), uniform(rng));
    const FootPoint foot = part.foot_point(point);
    double nearest = std::numeric_limits<double>::infinity();
    constexpr int kPlaces = 5000;
    for (int k = 0; k < kPlaces; ++k) {
      nearest = std::min(nearest, (part.position(5.0 * k / kPlaces) - point).norm());
    }
    EXPECT_LE(std::abs(foot.distance), nearest);
    // A place lies within 0.5 / kPlaces of any t; the speed is below 50 mm.
    EXPECT_GT(std::abs(foot.distance), nearest - 0.05 * 0.5 * 5.0 / kPlaces);
    EXPECT_GE(foot.t, 0.0);
    EXPECT_LT(foot.t, 5.0);
    EXPECT_LT((part.position(foot.t) - foot.position).norm(), 1e-15);
  }
}

TEST(ClosedSpline, FootOfAPointOffTheCurveIsWhereItCameFrom) {
  const ClosedSpline part = test::paper_part();
  ASSERT_GT(part.signed_area(), 0.0);  // counterclockwise: outside is on the right
  for (double t = 0.0; t < 5.0; t += 0.0625) {
    const CurveDerivatives d = part.derivatives(t);
    const FootPoint foot = part.foot_point(d.position - 0.01 * left_of(d.first.normalized()));
    EXPECT_NEAR(std::remainder(foot.t - t, 5.0), 0.0, 1e-12) << t;
    EXPECT_NEAR(foot.distance, -0.01, 1e-15) << t;
  }
}

TEST(ClosedSpline, FootOfWhatIsNotFiniteIsInfinitelyFar) {
  const FootPoint foot =
      test::paper_part().foot_point({std::numeric_limits<double>::quiet_NaN(), 0.0});
  EXPECT_EQ(foot.t, 0.0);
  EXPECT_EQ(foot.distance, std::numeric_limits<double>::infinity());
}

TEST(ClosedSpline, ArcLengthRunsOverJointsAndTurns) {
  const ClosedSpline part = test::paper_part();
  const double turn = part.arc_length(0.0, 5.0);
  EXPECT_NEAR(part.arc_length(-0.3, 9.7), 2.0 * turn, 1e-14);
  EXPECT_NEAR(part.arc_length(2.7, 1.1), -part.arc_length(1.1, 2.7), 1e-16);
  const double t = part.parameter_at_arc_length(4.5, 0.03);
  EXPECT_GT(t, 5.0);
  EXPECT_NEAR(part.arc_length(4.5, t), 0.03, 1e-15);
  EXPECT_NEAR(part.parameter_at_arc_length(t, -0.03), 4.5, 1e-13);
}

TEST(ClosedSpline, AreaIsThatOfAFinePolygon) {
  const ClosedSpline part = test::paper_part();
  double twice = 0.0;
  constexpr int kPlaces = 20000;
  for (int k = 0; k < kPlaces; ++k) {
    twice += cross(part.position(5.0 * k / kPlaces), part.position(5.0 * (k + 1) / kPlaces));
  }
  EXPECT_NEAR(part.signed_area(), 0.5 * twice, 1e-9);
}

TEST(ClosedSpline, CanonicalSegmentsAreTheSegments) {
  const ClosedSpline part = test::paper_part();
  for (std::size_t i = 0; i < part.size(); ++i) {
    const auto canonical = part.canonical_segment(i);
    ASSERT_TRUE(canonical.has_value());
    for (const double u : {0.0, 0.3, 1.0}) {
      const Vec2 point =
          canonical->shape_T_curve * canonical->curve.position(canonical->canonical_t(u));
      EXPECT_LT((point - part.segment(i).position(u)).norm(), 1e-15);
    }
  }
}

}  // namespace
}  // namespace palpate
