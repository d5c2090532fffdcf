// Eigenvalues and eigenvectors of small symmetric matrices, compiled once for all sizes.
//
// Eigen's eigensolvers take ten seconds and more to compile, again for every fixed size.
#pragma once

#include <Eigen/Core>

namespace palpate {

/// Rows of the largest matrix: shape and pose, at most six.
inline constexpr int kLargestSymmetric = 6;
using SmallSymmetric =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kLargestSymmetric, kLargestSymmetric>;
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kLargestSymmetric, 1>;

struct SymmetricEigen {
  SmallVector values;      ///< ascending
  SmallSymmetric vectors;  ///< orthonormal columns
};
SymmetricEigen symmetric_eigen(const SmallSymmetric& matrix);

/// The v for the smallest lambda with matrix v = lambda metric v, scaled to v^T metric v = 1.
/// `metric` is positive definite.
SmallVector least_generalised_eigenvector(const SmallSymmetric& matrix,
                                          const SmallSymmetric& metric);

}  // namespace palpate
