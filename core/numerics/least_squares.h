// Levenberg-Marquardt for residuals that provide their Jacobian.
#pragma once

#include <Eigen/Core>
#include <limits>

#include "core/numerics/levenberg_marquardt.h"

namespace palpate {

/// Adapts a residual class to `minimise`. Residuals are in units of their standard deviation. The
/// class has
///   enum { NUM_PARAMETERS };
///   int NumResiduals() const;
///   bool operator()(const double* x, double* residuals, double* jacobian) const;
/// `jacobian` is column-major. It is null for a trial step and not null for an accepted one. A
/// return value of false means that the residuals do not exist at x: a trial step is then rejected,
/// and a minimisation that starts at such an x does nothing.
template <typename Residuals>
class ResidualsProblem {
 public:
  static constexpr int kParameters = Residuals::NUM_PARAMETERS;
  using Vector = Eigen::Matrix<double, kParameters, 1>;
  using Matrix = Eigen::Matrix<double, kParameters, kParameters>;

  explicit ResidualsProblem(const Residuals& residuals)
      : residuals_(residuals),
        values_(residuals.NumResiduals()),
        jacobian_(residuals.NumResiduals(), kParameters) {}

  double chi2_at(const Vector& x) {
    tried_ = x;
    return residuals_(x.data(), values_.data(), nullptr) ? values_.squaredNorm()
                                                         : std::numeric_limits<double>::infinity();
  }

  void accept() { residuals_(tried_.data(), values_.data(), jacobian_.data()); }

  // Summed column by column: Eigen's general matrix product, optimised for hundreds of columns,
  // takes several times as long.
  void linearise(Matrix* information, Vector* gradient) {
    for (int i = 0; i < kParameters; ++i) {
      for (int j = 0; j <= i; ++j) {
        (*information)(i, j) = (*information)(j, i) = jacobian_.col(i).dot(jacobian_.col(j));
      }
      (*gradient)[i] = jacobian_.col(i).dot(values_);
    }
  }

 private:
  const Residuals& residuals_;
  Eigen::VectorXd values_;
  Eigen::Matrix<double, Eigen::Dynamic, kParameters> jacobian_;
  Vector tried_ = Vector::Zero();
};

/// Minimises the sum of squares of `residuals` from `*x`.
template <typename Residuals>
MinimiseSummary minimise_residuals(const Residuals& residuals, const MinimiseOptions& options,
                                   Eigen::Matrix<double, Residuals::NUM_PARAMETERS, 1>* x) {
  ResidualsProblem<Residuals> problem(residuals);
  return minimise(&problem, x, options);
}

}  // namespace palpate
