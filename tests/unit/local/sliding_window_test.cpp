// The sliding window: its reduced samples say what the samples say, its cost and memory are
// bounded.
#include "core/local/stream/sliding_window.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/local/stream/window_fit.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/test_rng.h"
#include "tests/support/touched_arc.h"

namespace palpate {
namespace {

/// Sums of weight, u, v, u^2, u v, u^3 along the principal axis x.
std::array<double, 6> sums_of(std::span<const PathNode> nodes, const Vec2& origin) {
  std::array<double, 6> sums{};
  for (const PathNode& node : nodes) {
    const Vec2 d = node.position_m - origin;
    const std::array<double, 6> terms = {1.0,           d.x(),         d.y(),
                                         d.x() * d.x(), d.x() * d.y(), d.x() * d.x() * d.x()};
    for (std::size_t i = 0; i < sums.size(); ++i) {
      sums[i] += node.weight * terms[i];
    }
  }
  return sums;
}

TEST(TwoNodes, KeepWhatALeastSquaresFitSees) {
  // v is a parabola whose product with u has no sum: the principal axis is x.
  const std::vector<PathNode> many = {
      {{-3.0, 0.1}, 1.0}, {{-1.0, -0.1}, 2.0}, {{1.0, -0.1}, 2.0}, {{3.0, 0.1}, 1.0}};
  const auto two = two_nodes(many);
  const auto expected = sums_of(many, {0.0, 0.0});
  const auto found = sums_of(two, {0.0, 0.0});
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(found[i], expected[i], 1e-13) << i;
  }
}

TEST(TwoNodes, OfSamplesInOnePlaceLieThere) {
  const std::vector<PathNode> many(5, {{2.0, -1.0}, 0.5});
  const auto two = two_nodes(many);
  EXPECT_EQ(two[0].position_m, Vec2(2.0, -1.0));
  EXPECT_EQ(two[0].weight + two[1].weight, 2.5);
}

TEST(NodePyramid, HoldsEverySampleOfItsWindowOnce) {
  NodePyramid pyramid;
  std::vector<PathNode> nodes;
  for (int i = 0; i < 5000; ++i) {
    pyramid.add({0.001 * i, 0.0}, 1.0);
    for (const std::uint64_t length : {16, 31, 100, 777, 4999}) {
      if (length > pyramid.count()) {
        continue;
      }
      const std::uint64_t asked = pyramid.count() - length;
      const std::uint64_t first = pyramid.window(asked, &nodes);
      ASSERT_GE(first, asked);
      // No more than one block of a sixteenth of the window is left out.
      ASSERT_LE(16 * (first - asked), length + 16);
      ASSERT_LE(nodes.size(), NodePyramid::kMostNodes);
      double weight = 0.0;
      double moment = 0.0;
      for (const PathNode& node : nodes) {
        weight += node.weight;
        moment += node.weight * node.position_m.x();
      }
      const auto held = static_cast<double>(pyramid.count() - first);
      ASSERT_NEAR(weight, held, 1e-9);
      ASSERT_NEAR(moment / weight, 0.0005 * static_cast<double>(first + pyramid.count() - 1), 1e-9);
    }
  }
}

/// Reduced or not, a window gives the same estimate: to a quarter of its standard deviation, which
/// adds three per cent to what the estimate errs.
TEST(NodePyramid, AWindowsEstimateIsThatOfItsSamples) {
  auto rng = test::test_rng();
  for (const test::TouchedArc& arc : test::touched_arcs()) {
    for (const int count : {64, 128, 256, 512, 1024}) {
      const double sigma = 4e-6;
      const std::vector<Vec2> samples = test::with_noise(test::samples_of(arc, count), sigma, rng);
      NodePyramid pyramid;
      for (const Vec2& p : samples) {
        pyramid.add(p, 1.0);
      }
      std::vector<PathNode> reduced;
      ASSERT_EQ(pyramid.window(0, &reduced), 0U);
      std::vector<PathNode> all;
      for (const Vec2& p : samples) {
        all.push_back({p, 1.0});
      }
      const LocalResult fast = fit_window(reduced, sigma, 0.0);
      const LocalResult direct = fit_window(all, sigma, 0.0);
      ASSERT_EQ(fast.status, direct.status) << arc.name << " " << count;
      if (!direct) {
        continue;
      }
      const LocalEstimate& a = fast.estimate;
      const LocalEstimate& b = direct.estimate;
      // Each against the truth at its own place: the middles of the two lie a little apart.
      const Eigen::Vector4d apart = test::error_of(a, arc) - test::error_of(b, arc);
      for (int k = 1; k < 4; ++k) {
        EXPECT_LT(std::abs(apart[k]) / std::sqrt(b.covariance(k, k)), 0.25)
            << arc.name << " " << count << " " << k;
      }
      // The covariance holds c^2 Var(share kept) of each fitted term c. A share lies between 0 and
      // 1, its variance is a quarter at most: where c, two of its deviations, moves by a quarter of
      // one, a quarter of the term's variance, an eighth of the deviation.
      for (int k = 0; k < 4; ++k) {
        EXPECT_NEAR(std::sqrt(a.covariance(k, k) / b.covariance(k, k)), 1.0, 0.125)
            << arc.name << " " << count;
      }
    }
  }
}

/// Splines whose inner bend has a radius of some three sample spacings.
TEST(SlidingWindow, BesideABendTheDeviationHoldsOrThereIsNoEstimate) {
  auto rng = test::test_rng();
  constexpr double kSigma = 1e-5;
  int estimates = 0;
  int beyond = 0;
  for (const Eigen::Vector3d& shape :
       {Eigen::Vector3d(15.582, -0.82201, 0.082246), Eigen::Vector3d(22.87, 0.89533, 0.052078),
        Eigen::Vector3d(19.727, -0.92105, 0.063407)}) {
    const test::TouchedArc arc{
        "bend", *make_curve(CurveClass::CubicSpline, shape), {0.1, 0.2, 0.7}, 0.0, 0.06, 1};
    for (int draw = 0; draw < 10; ++draw) {
      std::vector<PathNode> nodes;
      for (const Vec2& p : test::with_noise(test::samples_of(arc, 200), kSigma, rng)) {
        nodes.push_back({p, 1.0});
      }
      for (std::size_t length = 20; length <= 60; length += 5) {
        for (std::size_t first = 0; first + length <= nodes.size(); first += 3) {
          const LocalResult result =
              fit_window(std::span(nodes).subspan(first, length), kSigma, 0.0);
          if (result) {
            ++estimates;
            const Eigen::Vector4d error = test::error_of(result.estimate, arc);
            const auto sd = result.estimate.covariance.diagonal().cwiseSqrt();
            beyond += std::abs(error[2]) > 4.0 * sd[2] || std::abs(error[3]) > 4.0 * sd[3] ? 1 : 0;
          }
        }
      }
    }
  }
  // 4 deviations are passed by chance in 1e-4. What of a bend is beyond a window's polynomial, and
  // happens to look like none of its terms, is not known: rare, and stated here as one in two
  // hundred.
  RecordProperty("estimates", estimates);
  RecordProperty("beyond", beyond);
  EXPECT_GT(estimates, 5000);
  EXPECT_LT(beyond, estimates / 200);
}

TEST(SlidingWindow, EstimatesEveryShiftFromTheFirstWindowOnAndAllocatesNothing) {
  auto rng = test::test_rng();
  const std::vector<Vec2> samples =
      test::with_noise(test::samples_of(test::touched_arcs()[2], 300), 2e-5, rng);
  SlidingWindow window({.sigma_m = 2e-5});
  std::uint64_t expected = kFewestWindowNodes;
  std::uint64_t first = 0;
  const std::size_t before = test::allocation_count();
  std::uint64_t count = 0;
  for (const Vec2& p : samples) {
    const auto estimate = window.add(p);
    ++count;
    ASSERT_EQ(estimate.has_value(), count == expected);
    if (estimate) {
      expected += 4;
      ASSERT_EQ(estimate->end_sample, count);
      ASSERT_GE(estimate->first_sample, first);
      first = estimate->first_sample;
      ASSERT_EQ(estimate->result.status, LocalStatus::Ok);
    }
  }
  EXPECT_EQ(test::allocation_count(), before);
  window.reset();
  EXPECT_EQ(window.count(), 0U);
}

TEST(SlidingWindow, AllocatesNothingWhereTheNoiseIsNotStatedEither) {
  auto rng = test::test_rng();
  const std::vector<Vec2> samples =
      test::with_noise(test::samples_of(test::touched_arcs()[2], 600), 2e-5, rng);
  SlidingWindow window;
  const auto run = [&](std::size_t first, std::size_t end) {
    int estimates = 0;
    for (std::size_t i = first; i < end; ++i) {
      const auto estimate = window.add(samples[i]);
      estimates += estimate && estimate->result ? 1 : 0;
    }
    return estimates;
  };
  const std::size_t before = test::allocation_count();
  EXPECT_GT(run(0, 300), 0);
  window.reset();
  // Until a chunk is full, each estimate has the noise of what there is of it.
  EXPECT_GT(run(300, samples.size()), 0);
  EXPECT_EQ(test::allocation_count(), before);
}

/// A circle far away from the origin, for a hundred turns: the last window is as good as the first.
TEST(SlidingWindow, GathersNoRounding) {
  constexpr double kRadius = 0.02;
  const Vec2 centre(1e4, -2e4);
  SlidingWindow window({.sigma_m = 2e-6});
  auto rng = test::test_rng();
  std::normal_distribution<double> normal;
  double worst = 0.0;
  for (int i = 0; i < 62832; ++i) {
    const double angle = 0.01 * i;
    const Vec2 noise(normal(rng), normal(rng));
    const auto estimate =
        window.add(centre + kRadius * Vec2(std::cos(angle), std::sin(angle)) + 2e-6 * noise);
    if (i > 61000 && estimate) {
      ASSERT_EQ(estimate->result.status, LocalStatus::Ok);
      worst = std::max(worst, std::abs(estimate->result.estimate.kappa - 1.0 / kRadius) /
                                  std::sqrt(estimate->result.estimate.covariance(2, 2)));
    }
  }
  // Some ten independent windows: a normal law is beyond five once in 10^5 such runs.
  EXPECT_GT(worst, 0.0);
  EXPECT_LT(worst, 5.0);
}

}  // namespace
}  // namespace palpate
