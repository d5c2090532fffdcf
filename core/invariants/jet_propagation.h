// First-order propagation of covariances by automatic differentiation (Ceres Jets). No derivative
// of an invariant is written by hand.
#pragma once

#include <ceres/jet.h>

#include <Eigen/Core>
#include <array>

namespace palpate {

template <int M, int N>
struct Propagated {
  Eigen::Matrix<double, M, 1> value;
  Eigen::Matrix<double, M, N> jacobian;

  Eigen::Matrix<double, M, M> covariance(const Eigen::Matrix<double, N, N>& of_inputs) const {
    return jacobian * of_inputs * jacobian.transpose();
  }
};

/// `function` takes std::array<Jet, N> and returns std::array<Jet, M>.
template <int M, int N, typename Function>
Propagated<M, N> propagate(const Eigen::Matrix<double, N, 1>& inputs, Function&& function) {
  using Jet = ceres::Jet<double, N>;
  std::array<Jet, N> jets;
  for (int i = 0; i < N; ++i) {
    jets[static_cast<std::size_t>(i)] = Jet(inputs[i], i);
  }
  const std::array<Jet, M> outputs = function(jets);
  Propagated<M, N> result;
  for (int i = 0; i < M; ++i) {
    result.value[i] = outputs[static_cast<std::size_t>(i)].a;
    result.jacobian.row(i) = outputs[static_cast<std::size_t>(i)].v.transpose();
  }
  return result;
}

}  // namespace palpate
