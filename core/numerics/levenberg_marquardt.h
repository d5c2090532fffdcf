// Nonlinear least squares along curved valleys: Levenberg-Marquardt with geodesic acceleration.
//
// A short arc leaves some combinations of a curve's coefficients nearly free. Chi-square then has a
// long curved valley. Plain Levenberg-Marquardt is slow there, because each of its straight steps
// leaves the floor of the valley. The second-order term of Transtrum and Sethna (2012),
// "Improvements to the Levenberg-Marquardt algorithm for nonlinear least-squares minimization",
// follows the curve.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/matrices/small_cholesky.h"
#include "core/numerics/work_budget.h"

namespace palpate {

struct MinimiseOptions {
  int iterations = 100;          ///< largest number of steps tried
  double chi2_tolerance = 1e-7;  ///< stop when a step changes chi-square by less than this
  /// Above chi-square `coarse_above`: stop when a step changes chi-square by less than this
  /// fraction of it. A chi-square that no noise can explain need not be known precisely.
  double relative_tolerance = 0.0;
  double coarse_above = std::numeric_limits<double>::infinity();
  /// Relative to the diagonal of J^T J. Small, because the valleys of short arcs are long.
  double first_damping = 1e-8;
  /// Stop if the linear model predicts a chi-square above this: the fit cannot become relevant.
  double out_of_reach = std::numeric_limits<double>::infinity();
  /// What steps are counted in, and end with; nullptr: `iterations` alone bounds them.
  WorkBudget* work = nullptr;
  WorkKind row = WorkKind::PolynomialRow;  ///< of `rows` by each try
  std::size_t rows = 0;
};

struct MinimiseSummary {
  int iterations = 0;
  double initial_chi2 = 0.0;
  double chi2 = 0.0;
  /// Stopped because nothing was to be gained, with no more damping than a fresh start has; so a
  /// restart would not improve it.
  bool converged = false;
};

/// Minimises the sum of squares r(x)^T r(x) of `problem`, starting at `*x`. With the residuals r
/// and their Jacobian J, Problem has
///   static constexpr int kParameters;
///   double chi2_at(const Vector& x);   // evaluates a trial x
///   void accept();                     // makes the last trial x the current one
///   void linearise(Matrix* information, Vector* gradient);  // J^T J and J^T r there
/// and optionally
///   Vector bend(const Vector& step) const;  // J^T r'', r'' the second derivatives along `step`
/// Without `bend` the steps are those of plain Levenberg-Marquardt. Some directions in the
/// parameters may change no residual; the damping handles them.
template <typename Problem>
MinimiseSummary minimise(Problem* problem, Eigen::Matrix<double, Problem::kParameters, 1>* x,
                         const MinimiseOptions& options) {
  using Vector = Eigen::Matrix<double, Problem::kParameters, 1>;
  using Matrix = Eigen::Matrix<double, Problem::kParameters, Problem::kParameters>;
  // A parameter whose unit step changes no residual by more than a thousandth of its standard
  // deviation is damped as if it did.
  constexpr double kLeastDiagonal = 1e-6;
  // Above it the second-order term is too large to be a correction (Transtrum and Sethna).
  constexpr double kLargestRatio = 0.75;  // of accelerations to velocities
  // If the model predicts a gain below this fraction of the tolerance, the step is not tried.
  constexpr double kNothing = 1e-3;

  MinimiseSummary summary;
  const auto count = [&] {
    if (options.work != nullptr) {
      options.work->spend(options.row, options.rows);
      options.work->spend(WorkKind::FitStep, 1);
    }
  };
  count();
  summary.initial_chi2 = summary.chi2 = problem->chi2_at(*x);
  if (!std::isfinite(summary.chi2)) {
    return summary;
  }
  problem->accept();
  Matrix information;
  Vector gradient;
  Vector diagonal;
  const auto linearise = [&] {
    problem->linearise(&information, &gradient);
    diagonal = information.diagonal().cwiseMax(kLeastDiagonal);
  };
  linearise();
  double damping = options.first_damping;
  double growth = 2.0;
  while (summary.iterations < options.iterations &&
         (options.work == nullptr || options.work->allows())) {
    ++summary.iterations;
    Matrix damped = information;
    damped.diagonal() += damping * diagonal;
    const auto refuse = [&] {
      damping *= growth;
      growth *= 2.0;
    };
    Matrix factor;
    if (!cholesky(damped, &factor)) {  // by rounding, if the damping is nearly 0
      refuse();
      continue;
    }
    const Vector velocity = -solve_cholesky(factor, gradient);
    const double tolerance =
        summary.chi2 > options.coarse_above
            ? std::max(options.chi2_tolerance, options.relative_tolerance * summary.chi2)
            : options.chi2_tolerance;
    const double promised = velocity.dot(damping * diagonal.cwiseProduct(velocity) - gradient);
    if (!(promised > kNothing * tolerance)) {
      summary.converged = damping <= options.first_damping;
      break;
    }
    if (damping <= options.first_damping && summary.chi2 - promised > options.out_of_reach) {
      break;
    }
    Vector step = velocity;  // NOLINT(performance-unnecessary-copy-initialization): bent below
    if constexpr (requires { problem->bend(velocity); }) {
      const Vector acceleration = -solve_cholesky(factor, problem->bend(velocity));
      const auto length2 = [&](const Vector& v) { return v.cwiseAbs2().dot(diagonal); };
      if (length2(acceleration) <= kLargestRatio * kLargestRatio * length2(velocity)) {
        step += 0.5 * acceleration;
      }
    }
    const Vector there = *x + step;
    count();
    const double chi2 = problem->chi2_at(there);
    const double gain = summary.chi2 - chi2;
    if (gain > 0.0) {
      *x = there;
      summary.chi2 = chi2;
      problem->accept();
      if (gain < tolerance) {
        summary.converged = damping <= options.first_damping;
        break;
      }
      linearise();
      const double as_promised = 2.0 * gain / promised - 1.0;
      damping *= std::max(1.0 / 3.0, 1.0 - as_promised * as_promised * as_promised);
      growth = 2.0;
    } else {
      if (promised < tolerance) {
        break;
      }
      refuse();
    }
  }
  return summary;
}

}  // namespace palpate
