// Eigenvalues and eigenvectors of small symmetric matrices, compiled once for all sizes.
//
// Eigen compiles its eigensolvers anew for every fixed size, at ten and more seconds each.
#pragma once

#include <Eigen/Core>

namespace palpate {

/// Rows of the largest matrix: shape and pose, six at most.
inline constexpr int kLargestSymmetric = 6;
using SmallSymmetric =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kLargestSymmetric, kLargestSymmetric>;
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kLargestSymmetric, 1>;

struct SymmetricEigen {
  SmallVector values;      ///< ascending
  SmallSymmetric vectors;  ///< orthonormal columns
};
SymmetricEigen symmetric_eigen(const SmallSymmetric& matrix);

/// The v of the least lambda in matrix v = lambda metric v, with v^T metric v = 1; `metric` is
/// positive definite.
SmallVector least_generalised_eigenvector(const SmallSymmetric& matrix,
                                          const SmallSymmetric& metric);

}  // namespace palpate
