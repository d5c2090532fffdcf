// Least squares along bent valleys, and what polynomial curves tell it.
#include "core/numerics/levenberg_marquardt.h"

#include <gtest/gtest.h>

#include <random>

#include "core/recognition/fit/orthogonal/polynomial_problem.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

/// Rosenbrock's valley along y = x^2, with its optimum in (1, 1).
class Rosenbrock {
 public:
  static constexpr int kParameters = 2;
  using Vector = Eigen::Vector2d;
  using Matrix = Eigen::Matrix2d;

  explicit Rosenbrock(bool bent) : bent_(bent) {}

  double chi2_at(const Vector& x) {
    tried_ = x;
    return residuals().squaredNorm();
  }
  void accept() { accepted_ = tried_; }
  void linearise(Matrix* information, Vector* gradient) {
    tried_ = accepted_;
    *information = jacobian().transpose() * jacobian();
    *gradient = jacobian().transpose() * residuals();
  }
  Vector bend(const Vector& step) const {
    const Vector second(-2.0 * kSteep * step.x() * step.x(), 0.0);
    return bent_ ? Vector(jacobian().transpose() * second) : Vector::Zero();
  }

 private:
  static constexpr double kSteep = 1e3;
  Vector residuals() const {
    return {kSteep * (tried_.y() - tried_.x() * tried_.x()), 1.0 - tried_.x()};
  }
  Matrix jacobian() const {
    Matrix jacobian;
    jacobian << -2.0 * kSteep * accepted_.x(), kSteep, -1.0, 0.0;
    return jacobian;
  }

  bool bent_;
  Vector tried_ = Vector::Zero();
  Vector accepted_ = Vector::Zero();
};

TEST(LevenbergMarquardt, FollowsABentValley) {
  const Eigen::Vector2d start(-1.2, 1.44);
  const MinimiseOptions options{1000, 1e-12};
  Eigen::Vector2d x = start;
  Rosenbrock bent(true);
  const MinimiseSummary with = minimise(&bent, &x, options);
  EXPECT_NEAR(x.x(), 1.0, 1e-9);
  EXPECT_NEAR(x.y(), 1.0, 1e-9);
  EXPECT_EQ(with.initial_chi2, 2.2 * 2.2);

  Eigen::Vector2d crept = start;
  Rosenbrock straight(false);
  const MinimiseSummary without = minimise(&straight, &crept, options);
  // A third of the steps or so.
  EXPECT_LT(2 * with.iterations, without.iterations)
      << with.iterations << " against " << without.iterations;
}

TEST(LevenbergMarquardt, EndsWhereThereIsNothingToGain) {
  Eigen::Vector2d x(1.0, 1.0);
  Rosenbrock problem(true);
  const MinimiseSummary summary = minimise(&problem, &x, {100, 1e-9});
  EXPECT_EQ(summary.iterations, 1);
  EXPECT_EQ(x, Eigen::Vector2d(1.0, 1.0));
}

/// For one point with residual r and its derivatives J, r'' along v: gradient = J r, bend = J r'',
/// and (r^2 / 2)'' = (J v)^2 + r r''.
template <PolynomialModel kModel>
void expect_derivatives_of_one_point(std::mt19937_64& rng) {
  using Problem = PolynomialProblem<kModel>;
  using Vector = typename Problem::Vector;
  std::uniform_real_distribution<double> within(-1.0, 1.0);
  for (int i = 0; i < 100; ++i) {
    Vector x;
    Vector v;
    for (int k = 0; k < Problem::kParameters; ++k) {
      x[k] = (k < 2 ? 1.0 : k < 4 ? 0.6 : 0.3) * within(rng);
      v[k] = within(rng);
    }
    const double t = within(rng);
    const PolynomialCoefficients c = Problem::coefficients(x);
    const Vec2 first = first_derivative(c, t);
    const double speed = first.norm();
    const double curvature = cross(first, second_derivative(c, t)) / (speed * speed * speed);
    if (speed < 0.2 || std::abs(curvature) > 2.0) {
      continue;  // the differences below need a foot point that moves slowly
    }
    FitPoint point;
    point.position = position_at(c, t) + 0.1 * left_of(first) / speed;
    point.inverse_sigma = 3.0;
    Problem problem(std::span(&point, 1), std::span(&t, 1), 0);
    const double chi2 = problem.chi2_at(x);
    problem.accept();
    typename Problem::Matrix information;
    Vector gradient;
    problem.linearise(&information, &gradient);
    constexpr double h = 2e-4;
    const double after = problem.chi2_at(x + h * v);
    const double before = problem.chi2_at(x - h * v);
    // The differences err by h^2 of derivatives of the fourth order, far below 1e-3 here.
    EXPECT_NEAR(0.5 * (after - before) / (2.0 * h), gradient.dot(v), 1e-3);
    const double second = 0.5 * (after - 2.0 * chi2 + before) / (h * h);
    const double bend = second - v.dot(information * v);
    EXPECT_NEAR((chi2 * problem.bend(v) - bend * gradient).norm(), 0.0, 1e-3);
  }
}

TEST(PolynomialProblem, DerivativesAreThoseOfTheDistance) {
  std::mt19937_64 rng = test::test_rng();
  expect_derivatives_of_one_point<PolynomialModel::Parabola>(rng);
  expect_derivatives_of_one_point<PolynomialModel::CubicalParabola>(rng);
  expect_derivatives_of_one_point<PolynomialModel::SemiCubicalParabola>(rng);
  expect_derivatives_of_one_point<PolynomialModel::CubicSpline>(rng);
}

}  // namespace
}  // namespace palpate
