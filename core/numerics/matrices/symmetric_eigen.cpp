#include "core/numerics/matrices/symmetric_eigen.h"

#include <Eigen/Eigenvalues>

namespace palpate {

SymmetricEigen symmetric_eigen(const SmallSymmetric& matrix) {
  const Eigen::SelfAdjointEigenSolver<SmallSymmetric> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SmallVector least_generalised_eigenvector(const SmallSymmetric& matrix,
                                          const SmallSymmetric& metric) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<SmallSymmetric>(matrix, metric)
      .eigenvectors()
      .col(0);
}

}  // namespace palpate
