// Every estimator on every class: SE(2) equivariance, scaling, reversal of travel, and origins far
// away.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/local/estimator.h"
#include "tests/support/test_rng.h"
#include "tests/support/touched_arc.h"

namespace palpate {
namespace {

constexpr std::array kKinds = {EstimatorKind::FiniteDifference, EstimatorKind::Circle,
                               EstimatorKind::TwoRound, EstimatorKind::Jet};
constexpr double kSigma = 2e-5;
constexpr double kWindow = 0.022;

EstimatorOptions options_for(EstimatorKind kind, double sigma_m = kSigma) {
  EstimatorOptions options;
  options.kind = kind;
  options.sigma_m = sigma_m;
  options.window = kind == EstimatorKind::TwoRound ? 75 : 111;
  return options;
}

/// Compares estimates in units in which rounding of relative size `rounding` shows: the window's
/// length for the position, its powers for kappa and kappa_s.
void expect_same(const LocalEstimate& a, const LocalEstimate& b, double window, double tolerance) {
  EXPECT_NEAR((a.position - b.position).norm() / window, 0.0, tolerance);
  EXPECT_NEAR(wrap_angle(a.tangent_angle - b.tangent_angle), 0.0, tolerance);
  EXPECT_NEAR((a.kappa - b.kappa) * window, 0.0, tolerance);
  EXPECT_NEAR((a.kappa_s - b.kappa_s) * window * window, 0.0, tolerance);
  const Eigen::Vector4d sd = a.covariance.diagonal().cwiseSqrt();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      EXPECT_NEAR(a.covariance(i, j) / (sd[i] * sd[j]), b.covariance(i, j) / (sd[i] * sd[j]),
                  1e3 * tolerance);
    }
  }
}

/// Tolerance for two computations of an estimate from coordinates rounded to `rounding` (relative
/// to the window). kappa_s amplifies rounding by at most 3e3 / window^2: its standard deviation
/// over 111 samples is 1400 sigma / window^3 for five points, times sqrt(2) because both
/// computations have it.
double tolerance_for(double rounding) { return 4e3 * rounding; }

class EstimatorSymmetry : public testing::TestWithParam<std::tuple<EstimatorKind, std::size_t>> {
 protected:
  void SetUp() override {
    kind_ = std::get<0>(GetParam());
    auto rng = test::test_rng();
    arc_ = test::touched_arcs()[std::get<1>(GetParam())];
    arc_.world_T_curve.x = 0.0;
    arc_.world_T_curve.y = 0.0;
    samples_ = test::with_noise(test::samples_of(arc_, 111), kSigma, rng);
    const LocalResult result = estimate_window(samples_, options_for(kind_));
    ASSERT_EQ(result.status, LocalStatus::Ok);
    base_ = result.estimate;
  }

  EstimatorKind kind_ = EstimatorKind::Jet;
  test::TouchedArc arc_;
  std::vector<Vec2> samples_;
  LocalEstimate base_;
};

INSTANTIATE_TEST_SUITE_P(AllClasses, EstimatorSymmetry,
                         testing::Combine(testing::ValuesIn(kKinds),
                                          testing::Range(std::size_t{0},
                                                         test::touched_arcs().size())),
                         [](const auto& param_info) {
                           std::string name =
                               std::string(name_of(std::get<0>(param_info.param))) + "_" +
                               test::touched_arcs()[std::get<1>(param_info.param)].name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST_P(EstimatorSymmetry, Pose) {
  auto rng = test::test_rng(1);
  std::uniform_real_distribution<double> angle(-kPi, kPi);
  std::uniform_real_distribution<double> shift(-1.0, 1.0);
  for (int i = 0; i < test::stress_count(50); ++i) {
    const Pose2 pose{shift(rng), shift(rng), angle(rng)};
    std::vector<Vec2> moved;
    for (const Vec2& p : samples_) {
      moved.push_back(pose * p);
    }
    const LocalResult result = estimate_window(moved, options_for(kind_));
    ASSERT_EQ(result.status, LocalStatus::Ok);
    LocalEstimate expected = base_;
    expected.position = pose * base_.position;
    expected.tangent_angle = base_.tangent_angle + pose.theta;
    // Coordinates up to 2 m, rounded several times to 2.2e-16 m.
    expect_same(result.estimate, expected, kWindow, tolerance_for(1e-15 / kWindow));
  }
}

TEST_P(EstimatorSymmetry, OriginAThousandKilometresAway) {
  const Vec2 far(1e6, -1e6);
  std::vector<Vec2> moved;
  for (const Vec2& p : samples_) {
    moved.push_back(p + far);
  }
  const LocalResult result = estimate_window(moved, options_for(kind_));
  ASSERT_EQ(result.status, LocalStatus::Ok);
  LocalEstimate expected = base_;
  expected.position += far;
  // Coordinates of 1e6 m are rounded to 5.8e-11 m; the difference is the rounding of the samples.
  expect_same(result.estimate, expected, kWindow, tolerance_for(1.2e-10 / kWindow));
}

TEST_P(EstimatorSymmetry, Scale) {
  for (const double factor : {1e-6, 1e-3, 0.37, 1e3, 1e6}) {
    std::vector<Vec2> scaled;
    for (const Vec2& p : samples_) {
      scaled.push_back(factor * p);
    }
    const LocalResult result = estimate_window(scaled, options_for(kind_, factor * kSigma));
    ASSERT_EQ(result.status, LocalStatus::Ok) << factor;
    LocalEstimate expected = base_;
    expected.position *= factor;
    expected.kappa /= factor;
    expected.kappa_s /= factor * factor;
    const Eigen::Vector4d units(factor, 1.0, 1.0 / factor, 1.0 / (factor * factor));
    expected.covariance = units.asDiagonal() * base_.covariance * units.asDiagonal();
    // Coordinates up to 0.05 m, rounded to 7e-18 m.
    expect_same(result.estimate, expected, factor * kWindow, tolerance_for(2e-17 / kWindow));
    EXPECT_NEAR(result.estimate.window_arc_m / factor, base_.window_arc_m, 1e-13);
  }
}

TEST_P(EstimatorSymmetry, Reversal) {
  std::vector<Vec2> reversed(samples_.rbegin(), samples_.rend());
  EstimatorOptions options = options_for(kind_);
  if (kind_ == EstimatorKind::TwoRound) {
    // An odd number has its middle window in the middle in both directions.
    options.two_round_fits = 11;
    options.window = 71;
    const LocalResult forwards = estimate_window(samples_, options);
    ASSERT_EQ(forwards.status, LocalStatus::Ok);
    base_ = forwards.estimate;
  }
  const LocalResult result = estimate_window(reversed, options);
  ASSERT_EQ(result.status, LocalStatus::Ok);
  LocalEstimate expected = base_;
  expected.tangent_angle += kPi;
  expected.kappa = -base_.kappa;
  const Eigen::Vector4d signs(-1.0, 1.0, -1.0, 1.0);
  expected.covariance = signs.asDiagonal() * base_.covariance * signs.asDiagonal();
  if (kind_ == EstimatorKind::TwoRound) {
    // Arc lengths are computed by Simpson's rule on each window's own parabola, which differs when
    // travelled backwards: kappa_s agrees to the relative difference of the arc lengths, 1e-3.
    EXPECT_NEAR(result.estimate.kappa_s / base_.kappa_s, 1.0, 1e-2);
    expected.kappa_s = result.estimate.kappa_s;
    expected.covariance = result.estimate.covariance;
  }
  expect_same(result.estimate, expected, kWindow, tolerance_for(2e-17 / kWindow));
}

}  // namespace
}  // namespace palpate
