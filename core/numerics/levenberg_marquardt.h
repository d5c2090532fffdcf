// Least squares along bent valleys: Levenberg-Marquardt with geodesic acceleration.
//
// A short arc leaves combinations of a curve's coefficients nearly free. Chi-square then has a long
// bent valley, in which plain Levenberg-Marquardt creeps: each of its straight steps leaves the
// valley's floor. The second-order term of Transtrum and Sethna (2012), "Improvements to the
// Levenberg-Marquardt algorithm for nonlinear least-squares minimization", follows the bend.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/small_cholesky.h"
#include "core/numerics/work_budget.h"

namespace palpate {

struct MinimiseOptions {
  int iterations = 100;          ///< steps tried, at most
  double chi2_tolerance = 1e-7;  ///< change of chi-square by a step at which to end
  /// The same of chi-square, where that is above `coarse_above`: what no noise can have left need
  /// not be known as if it had.
  double relative_tolerance = 0.0;
  double coarse_above = std::numeric_limits<double>::infinity();
  /// Of the diagonal of J^T J. Little: the valleys of short arcs are long.
  double first_damping = 1e-8;
  /// Ends where the linear model leaves more than this: so far off nothing is to be told.
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
  /// Ended with nothing to gain and no more damping than a fresh start has: that would not go on.
  bool converged = false;
};

/// Minimises `problem`'s sum of squares r(x)^T r(x) from `*x`. With r' the derivatives of the
/// residuals, J their Jacobian, Problem has
///   static constexpr int kParameters;
///   double chi2_at(const Vector& x);   // tries x
///   void accept();                     // the place tried last is where we are
///   void linearise(Matrix* information, Vector* gradient) const;  // J^T J and J^T r there
/// and may have
///   Vector bend(const Vector& step) const;  // J^T r'', r'' the second derivatives along `step`
/// without which the steps are those of Levenberg and Marquardt alone.
/// Where `options.work` is spent, it stays where it has come to; it always looks at `*x`.
/// Directions that leave the residuals as they are may be among the parameters: the damping takes
/// care of them.
template <typename Problem>
MinimiseSummary minimise(Problem* problem, Eigen::Matrix<double, Problem::kParameters, 1>* x,
                         const MinimiseOptions& options) {
  using Vector = Eigen::Matrix<double, Problem::kParameters, 1>;
  using Matrix = Eigen::Matrix<double, Problem::kParameters, Problem::kParameters>;
  // What changes no residual by more than a thousandth of its deviation, for a unit step, is damped
  // as if it did.
  constexpr double kLeastDiagonal = 1e-6;
  // Beyond it the second-order term is no correction any more (Transtrum and Sethna).
  constexpr double kLargestRatio = 0.75;  // of accelerations to velocities
  // Where the model promises less than this part of the tolerance, there is no need to try.
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
    if (!cholesky(damped, &factor)) {  // by rounding, where next to nothing is damped
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
