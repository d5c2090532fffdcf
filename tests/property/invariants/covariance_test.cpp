// Checks the reported covariances and chi-squares of the invariants by Monte Carlo.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "core/invariants/conic_invariants.h"
#include "core/invariants/conic_line.h"
#include "core/invariants/conic_parameters.h"
#include "core/invariants/constant_curvature.h"
#include "core/invariants/cubical_parabola_invariants.h"
#include "core/invariants/semi_cubical_parabola_invariants.h"
#include "core/invariants/signature_fit/conic_start.h"
#include "core/invariants/signature_fit/semi_signature_fit.h"
#include "core/numerics/probability/chi_square.h"
#include "tests/support/canonical_points.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

using test::PlacedCurve;

constexpr int kTrials = 2000;

/// Maximum relative difference between the variance of the trials and the reported one. The
/// standard deviation of a variance from 2,000 Gaussian trials is 3.2 %; the rest allows for
/// second-order effects.
constexpr double kVarianceTolerance = 0.15;

/// Joint noise of angle, kappa and kappa_s, correlated as in a polynomial fit.
Eigen::Matrix3d noise_covariance(const MeasuredGeometry& point, double relative) {
  const double size = curvature_scale({&point, 1});
  const Eigen::Vector3d sd = relative * Eigen::Vector3d(0.3, size, 3.0 * size * size);
  Eigen::Matrix3d correlation;
  correlation << 1.0, 0.1, -0.6, 0.1, 1.0, 0.2, -0.6, 0.2, 1.0;
  return sd.asDiagonal() * correlation * sd.asDiagonal();
}

void set_noise(std::vector<MeasuredGeometry>& points, double relative) {
  for (MeasuredGeometry& point : points) {
    point.covariance = noise_covariance(point, relative);
  }
}

std::vector<MeasuredGeometry> noisy(const std::vector<MeasuredGeometry>& points,
                                    std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  std::vector<MeasuredGeometry> result = points;
  for (MeasuredGeometry& point : result) {
    const Eigen::Vector3d white(normal(rng), normal(rng), normal(rng));
    const Eigen::Vector3d error = point.covariance.llt().matrixL() * white;
    point.tangent_angle += error[0];
    point.kappa += error[1];
    point.kappa_s += error[2];
  }
  return result;
}

/// Mean, covariance and mean chi-square of the trials.
struct Sample {
  explicit Sample(int size)
      : sum(Eigen::VectorXd::Zero(size)), squares(Eigen::MatrixXd::Zero(size, size)) {}
  void add(const Eigen::VectorXd& value) {
    sum += value;
    squares += value * value.transpose();
    ++count;
  }
  Eigen::VectorXd mean() const { return sum / count; }
  Eigen::MatrixXd covariance() const {
    return (squares - sum * sum.transpose() / count) / (count - 1);
  }
  Eigen::VectorXd sum;
  Eigen::MatrixXd squares;
  int count = 0;
};

void expect_same_variances(const Sample& sample, const Eigen::MatrixXd& reported) {
  const Eigen::MatrixXd measured = sample.covariance();
  for (int i = 0; i < reported.rows(); ++i) {
    EXPECT_NEAR(measured(i, i) / reported(i, i), 1.0, kVarianceTolerance) << i;
    for (int j = 0; j < i; ++j) {
      const double size = std::sqrt(reported(i, i) * reported(j, j));
      EXPECT_NEAR(measured(i, j) / size, reported(i, j) / size, kVarianceTolerance);
    }
  }
}

std::vector<MeasuredGeometry> points_of(const PlacedCurve& curve,
                                        const std::vector<double>& places) {
  std::vector<MeasuredGeometry> points;
  for (const double t : places) {
    points.push_back(measured_geometry(test::exact_estimate(curve, t)));
  }
  return points;
}

TEST(CovarianceOf, ConicPair) {
  auto rng = test::test_rng();
  auto points = points_of({CurveClass::Ellipse, {2.0, 1.2, 0.0}, {}}, {0.4, 1.2});
  set_noise(points, 1e-3);
  const ConicInvariants exact = conic_invariants(points[0], points[1]);
  Sample sample(2);
  for (int i = 0; i < kTrials; ++i) {
    const auto trial = noisy(points, rng);
    const ConicInvariants result = conic_invariants(trial[0], trial[1]);
    ASSERT_EQ(result.status, InvariantStatus::Ok);
    sample.add(Eigen::Vector2d(result.ic1, result.ic2));
  }
  expect_same_variances(sample, exact.covariance);
}

TEST(CovarianceOf, CubicalParabolaPair) {
  auto rng = test::test_rng();
  auto points = points_of({CurveClass::CubicalParabola, {1.2, -0.4, 0.0}, {}}, {0.3, -0.6});
  set_noise(points, 3e-4);
  const PairSolutions exact = cubical_parabola_pair(points[0], points[1]);
  ASSERT_EQ(exact.status, InvariantStatus::Ok);
  Sample sample(2);
  for (int i = 0; i < kTrials; ++i) {
    const auto trial = noisy(points, rng);
    const PairSolutions result = cubical_parabola_pair(trial[0], trial[1]);
    ASSERT_EQ(result.status, InvariantStatus::Ok);
    sample.add(result.solutions[0].parameters);
  }
  expect_same_variances(sample, exact.solutions[0].covariance);
}

TEST(CovarianceOf, SemiCubicalParabolaPair) {
  auto rng = test::test_rng();
  auto points = points_of({CurveClass::SemiCubicalParabola, {1.2, -0.4, 0.0}, {}}, {0.5, -0.7});
  set_noise(points, 3e-4);
  const PairSolutions exact = semi_cubical_parabola_pair(points[0], points[1]);
  ASSERT_EQ(exact.status, InvariantStatus::Ok);
  Sample sample(2);
  for (int i = 0; i < kTrials; ++i) {
    const auto trial = noisy(points, rng);
    const PairSolutions result = semi_cubical_parabola_pair(trial[0], trial[1]);
    ASSERT_EQ(result.status, InvariantStatus::Ok);
    sample.add(result.solutions[0].parameters);
  }
  expect_same_variances(sample, exact.solutions[0].covariance);
}

/// Fraction of trials beyond the 5 % point of the chi-square distribution; its binomial standard
/// deviation is 0.5 %.
struct Rejections {
  void add(double chi2, int dof) {
    rejected += chi2 > chi_square_threshold(0.05, dof) ? 1 : 0;
    ++count;
  }
  double rate() const { return static_cast<double>(rejected) / count; }
  int rejected = 0;
  int count = 0;
};

TEST(CovarianceOf, ConicLineWithVertices) {
  auto rng = test::test_rng();
  // All four vertices (kappa_s = 0, where Ip has no first-order error) and four points between
  // them.
  auto points = points_of({CurveClass::Ellipse, {2.0, 1.2, 0.0}, {}},
                          {0.0, 0.5, 0.5 * kPi, 2.0, kPi, 4.0, 1.5 * kPi, 5.5});
  set_noise(points, 0.01);
  const ConicLine exact = fit_conic_line(points);
  ASSERT_EQ(exact.status, InvariantStatus::Ok);
  Sample sample(2);
  Rejections rejections;
  for (int i = 0; i < kTrials; ++i) {
    const ConicLine line = fit_conic_line(noisy(points, rng));
    ASSERT_EQ(line.status, InvariantStatus::Ok);
    sample.add(Eigen::Vector2d(line.ic1, line.ic2));
    rejections.add(line.chi2, line.dof);
  }
  EXPECT_NEAR(rejections.rate(), 0.05, 0.02);
  const Eigen::Vector2d truth(std::pow(2.4, -2.0 / 3.0), (4.0 + 1.44) * std::pow(2.4, -4.0 / 3.0));
  const Eigen::Vector2d sd = sample.covariance().diagonal().cwiseSqrt();
  EXPECT_NEAR(sample.mean()[0], truth[0], 0.2 * sd[0]);
  EXPECT_NEAR(sample.mean()[1], truth[1], 0.2 * sd[1]);
  EXPECT_NEAR(sd[0] / std::sqrt(exact.covariance(0, 0)), 1.0, 0.15);
  EXPECT_NEAR(sd[1] / std::sqrt(exact.covariance(1, 1)), 1.0, 0.15);
}

TEST(CovarianceOf, ConstantCurvature) {
  auto rng = test::test_rng();
  std::vector<MeasuredGeometry> points(6);
  for (MeasuredGeometry& point : points) {
    point.kappa = 2.0;
  }
  set_noise(points, 0.02);
  const ConstantCurvature exact = fit_constant_curvature(points);
  Sample sample(1);
  Rejections rejections;
  for (int i = 0; i < kTrials; ++i) {
    const ConstantCurvature fit = fit_constant_curvature(noisy(points, rng));
    sample.add(Eigen::Matrix<double, 1, 1>(fit.kappa));
    rejections.add(fit.circle_chi2, fit.circle_dof);
  }
  expect_same_variances(sample, Eigen::Matrix<double, 1, 1>(exact.variance));
  EXPECT_NEAR(rejections.rate(), 0.05, 0.02);
}

class SemiSignature : public testing::TestWithParam<CurveClass> {};

INSTANTIATE_TEST_SUITE_P(CovarianceOf, SemiSignature,
                         testing::ValuesIn(test::invariant_classes().begin(),
                                           test::invariant_classes().end()),
                         [](const auto& param_info) {
                           return std::string(name_of(param_info.param));
                         });

TEST_P(SemiSignature, FitIsTrue) {
  auto rng = test::test_rng();
  const CurveClass curve_class = GetParam();
  const PlacedCurve curve =
      curve_class == CurveClass::CubicSpline
          ? PlacedCurve{curve_class, {1.2, 0.5, -0.8}, {}}
          : PlacedCurve{
                curve_class, {1.5, curve_class == CurveClass::Parabola ? 0.0 : 0.8, 0.0}, {}};
  auto points = points_of(curve, {-1.1, -0.7, -0.3, 0.35, 0.6, 0.9, 1.2});
  set_noise(points, 1e-3);
  const int size = static_cast<int>(parameter_letters(curve_class).size()) + 1;
  const auto exact = fit_semi_signature(curve_class, points, curve.parameters, 0.0);
  ASSERT_EQ(exact.status, InvariantStatus::Ok);
  Sample sample(size);
  Rejections rejections;
  for (int i = 0; i < kTrials; ++i) {
    const auto fit = fit_semi_signature(curve_class, noisy(points, rng), curve.parameters, 0.0);
    ASSERT_EQ(fit.status, InvariantStatus::Ok);
    Eigen::VectorXd value(size);
    value << fit.parameters.head(size - 1), fit.orientation;
    sample.add(value);
    rejections.add(fit.chi2, fit.dof);
  }
  expect_same_variances(sample, exact.covariance.topLeftCorner(size, size));
  EXPECT_NEAR(rejections.rate(), 0.05, 0.02);
}

}  // namespace
}  // namespace palpate
