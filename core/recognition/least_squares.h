// Least squares by Levenberg and Marquardt's method, for residuals in units of their standard
// deviation and few parameters.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {

/// Little damping to begin with: the valleys of short arcs are long, and damping grows fast where a
/// step fails.
struct LeastSquaresOptions {
  int max_iterations = 50;
  double chi2_tolerance = 1e-6;   ///< ends where a step changes chi-square by less, absolute
  double step_tolerance = 1e-14;  ///< ends where a step is shorter than this, relative to x
  double trust_radius = 1e8;      ///< of the first step, in scaled parameters: 1 / damping
};

struct LeastSquaresSummary {
  double initial_chi2 = std::numeric_limits<double>::infinity();
  double chi2 = std::numeric_limits<double>::infinity();
  int iterations = 0;
};

/// Steps and tests are those of ceres::TinySolver (K. Madsen, H. Nielsen, O. Tingleff, Methods for
/// Non-Linear Least Squares Problems, 2004), for which a class of residuals serves as it is:
/// bool operator()(const double* x, double* residuals, double* jacobian), `jacobian` null at a
/// trial, column by column at what was accepted. False says that there is nothing at x: a trial
/// is refused, from such a start nothing is done. The normal matrix is summed column by column: a
/// general product of matrices, whose packing pays for hundreds of columns, costs several times
/// as much.
template <typename Residuals>
class LeastSquares {
 public:
  static constexpr int kParameters = Residuals::NUM_PARAMETERS;
  using Parameters = Eigen::Matrix<double, kParameters, 1>;

  LeastSquaresSummary minimise(const Residuals& residuals, const LeastSquaresOptions& options,
                               Parameters* x) {
    const Eigen::Index n = residuals.NumResiduals();
    values_.resize(n);
    jacobian_.resize(n, kParameters);
    LeastSquaresSummary summary;
    if (!residuals(x->data(), values_.data(), jacobian_.data())) {
      return summary;
    }
    sum_normal_equations();
    // 1 is added to the denominator for the sake of small entries.
    const Parameters scale = (1.0 + normal_.diagonal().array().sqrt()).inverse();
    scale_normal_equations(scale);
    summary.initial_chi2 = summary.chi2 = values_.squaredNorm();
    double damping = 1.0 / options.trust_radius;
    double growth = 2.0;
    for (summary.iterations = 1; summary.iterations < options.max_iterations;
         ++summary.iterations) {
      constexpr double kLeastDiagonal = 1e-6;
      constexpr double kLargestDiagonal = 1e32;
      Normal damped = normal_;
      damped.diagonal() +=
          damping * normal_.diagonal().cwiseMax(kLeastDiagonal).cwiseMin(kLargestDiagonal);
      const Parameters scaled_step = solve(damped);
      const Parameters step = scale.cwiseProduct(scaled_step);
      if (step.norm() < options.step_tolerance * (x->norm() + options.step_tolerance)) {
        break;
      }
      const Parameters trial = *x + step;
      const bool there = residuals(trial.data(), values_.data(), nullptr);
      const double chi2 = there ? values_.squaredNorm() : std::numeric_limits<double>::infinity();
      const double decrease = summary.chi2 - chi2;
      const double predicted = scaled_step.dot(2.0 * gradient_ - normal_ * scaled_step);
      const double ratio = decrease / predicted;
      const bool last = std::abs(decrease) < options.chi2_tolerance;
      if (there && ratio > 0.0) {
        *x = trial;
        summary.chi2 = chi2;
        if (last || !residuals(x->data(), values_.data(), jacobian_.data())) {
          break;
        }
        sum_normal_equations();
        scale_normal_equations(scale);
        const double excess = 2.0 * ratio - 1.0;
        damping *= std::max(1.0 / 3.0, 1.0 - excess * excess * excess);
        growth = 2.0;
      } else if (last) {
        break;
      } else {
        damping *= growth;
        growth *= 2.0;
      }
    }
    return summary;
  }

 private:
  using Normal = Eigen::Matrix<double, kParameters, kParameters>;

  void sum_normal_equations() {
    for (int i = 0; i < kParameters; ++i) {
      for (int j = 0; j <= i; ++j) {
        normal_(i, j) = normal_(j, i) = jacobian_.col(i).dot(jacobian_.col(j));
      }
      gradient_[i] = -jacobian_.col(i).dot(values_);
    }
  }

  Parameters solve(const Normal& damped) const {
    if constexpr (kParameters == 1) {
      return gradient_ / damped(0, 0);
    } else {
      return damped.ldlt().solve(gradient_);
    }
  }

  void scale_normal_equations(const Parameters& scale) {
    normal_ = scale.asDiagonal() * normal_ * scale.asDiagonal();
    gradient_ = scale.cwiseProduct(gradient_);
  }

  Eigen::VectorXd values_;
  Eigen::Matrix<double, Eigen::Dynamic, kParameters> jacobian_;
  Normal normal_;        ///< J^T J of the scaled parameters
  Parameters gradient_;  ///< -J^T r of the scaled parameters
};

}  // namespace palpate
