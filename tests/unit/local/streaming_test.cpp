// The ring buffer, and estimates along a stream: the same as over the whole, without allocation.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/local/estimator.h"
#include "core/local/ring_buffer.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/test_rng.h"
#include "tests/support/touched_arc.h"

namespace palpate {
namespace {

TEST(RingBuffer, HoldsTheNewestInOrder) {
  RingBuffer<int> buffer(4);
  EXPECT_EQ(buffer.size(), 0U);
  for (int i = 0; i < 11; ++i) {
    buffer.push(i);
    const auto values = buffer.values();
    ASSERT_EQ(values.size(), std::min<std::size_t>(4, static_cast<std::size_t>(i) + 1));
    for (std::size_t k = 0; k < values.size(); ++k) {
      EXPECT_EQ(values[k], i + 1 - static_cast<int>(values.size() - k));
    }
    EXPECT_EQ(buffer.newest(1)[0], i);
  }
  EXPECT_TRUE(buffer.full());
  buffer.clear();
  EXPECT_EQ(buffer.size(), 0U);
  buffer.push(5);
  EXPECT_EQ(buffer.values()[0], 5);
}

class Streaming : public testing::TestWithParam<EstimatorKind> {};

INSTANTIATE_TEST_SUITE_P(AllEstimators, Streaming,
                         testing::Values(EstimatorKind::FiniteDifference, EstimatorKind::Circle,
                                         EstimatorKind::TwoRound, EstimatorKind::Jet));

TEST_P(Streaming, SameAsOverTheWholeAndNothingAllocated) {
  auto rng = test::test_rng();
  const std::vector<Vec2> samples =
      test::with_noise(test::samples_of(test::touched_arcs()[2], 300), 2e-5, rng);
  EstimatorOptions options;
  options.kind = GetParam();
  const std::vector<WindowResult> whole = estimate_all(samples, options);
  ASSERT_FALSE(whole.empty());

  StreamingEstimator stream(options);
  std::vector<WindowResult> streamed;
  streamed.reserve(whole.size());
  const std::size_t before = test::allocation_count();
  for (const Vec2& p : samples) {
    if (const auto result = stream.add(p)) {
      streamed.push_back(*result);
    }
  }
  EXPECT_EQ(test::allocation_count(), before);
  ASSERT_EQ(streamed.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(streamed[i].first_sample, whole[i].first_sample);
    EXPECT_EQ(streamed[i].result.status, whole[i].result.status);
    EXPECT_EQ(streamed[i].result.estimate.kappa, whole[i].result.estimate.kappa);
    EXPECT_EQ(streamed[i].result.estimate.kappa_s, whole[i].result.estimate.kappa_s);
    EXPECT_EQ(streamed[i].result.estimate.covariance, whole[i].result.estimate.covariance);
  }
  stream.reset();
  EXPECT_FALSE(stream.add(samples[0]).has_value());
}

TEST(Estimator, NamesReadBack) {
  for (const auto kind : {EstimatorKind::FiniteDifference, EstimatorKind::Circle,
                          EstimatorKind::TwoRound, EstimatorKind::Jet}) {
    EXPECT_EQ(estimator_kind_from_name(name_of(kind)), kind);
  }
  EXPECT_FALSE(estimator_kind_from_name("spline").has_value());
}

TEST(Estimator, TwoRoundTakesThePapersSamples) {
  EstimatorOptions options;
  options.kind = EstimatorKind::TwoRound;
  EXPECT_EQ(samples_per_estimate(options), 111U);  // 75 + 9 * 4
}

}  // namespace
}  // namespace palpate
