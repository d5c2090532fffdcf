#include "core/numerics/polynomials/orthogonal_polynomials.h"

#include <Eigen/Eigenvalues>
#include <cassert>
#include <cmath>

namespace palpate {

OrthogonalPolynomials::OrthogonalPolynomials(std::span<const double> x, std::span<const double> w,
                                             std::span<const double> y, int degree)
    : degree_(degree) {
  assert(degree >= 0 && degree <= kMaxDegree && x.size() == w.size() && x.size() == y.size());
  const std::size_t n = x.size();
  std::vector<double> residual(y.begin(), y.end());
  std::vector<double> previous(n, 0.0);
  std::vector<double> current(n, 1.0);
  double previous_norm = 1.0;
  for (int d = 0; d <= degree; ++d) {
    double norm = 0.0;
    double moment = 0.0;
    double projection = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double wp = w[i] * current[i];
      norm += wp * current[i];
      moment += wp * current[i] * x[i];
      projection += wp * residual[i];
    }
    if (d == 0) {
      weight_sum_ = norm;
    }
    const auto k = static_cast<std::size_t>(d);
    coefficient_[k] = norm > 0.0 ? projection / norm : 0.0;
    alpha_[k] = norm > 0.0 ? moment / norm : 0.0;
    beta_[k] = d > 0 && previous_norm > 0.0 ? norm / previous_norm : 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      residual[i] -= coefficient_[k] * current[i];
      sum += w[i] * residual[i] * residual[i];
      const double next = (x[i] - alpha_[k]) * current[i] - beta_[k] * previous[i];
      previous[i] = current[i];
      current[i] = next;
    }
    residual_sum_[k] = sum;
    previous_norm = norm;
  }
}

void OrthogonalPolynomials::rescale(double of_y, double of_w) {
  weight_sum_ *= of_w;
  for (std::size_t k = 0; k < kSize; ++k) {
    coefficient_[k] *= of_y;
    residual_sum_[k] *= of_w * of_y * of_y;
  }
}

template <typename Visit>
void OrthogonalPolynomials::for_each_polynomial(double x, int d, const Visit& visit) const {
  double before = 0.0;
  double before_derivative = 0.0;
  double p = 1.0;
  double p_derivative = 0.0;
  for (std::size_t k = 0; k <= static_cast<std::size_t>(d); ++k) {
    visit(k, p, p_derivative);
    const double next = (x - alpha_[k]) * p - beta_[k] * before;
    const double next_derivative =
        p + (x - alpha_[k]) * p_derivative - beta_[k] * before_derivative;
    before = p;
    before_derivative = p_derivative;
    p = next;
    p_derivative = next_derivative;
  }
}

OrthogonalPolynomials::Value OrthogonalPolynomials::evaluate(double x, int d) const {
  Value value;
  for_each_polynomial(x, d, [&](std::size_t k, double p, double p_derivative) {
    value.value += coefficient_[k] * p;
    value.derivative += coefficient_[k] * p_derivative;
  });
  return value;
}

double OrthogonalPolynomials::slope_variance(double x, int d) const {
  double norm = weight_sum_;
  double variance = 0.0;
  for_each_polynomial(x, d, [&](std::size_t k, double, double p_derivative) {
    norm *= k > 0 ? beta_[k] : 1.0;
    variance += p_derivative * p_derivative / norm;
  });
  return variance;
}

std::vector<OrthogonalPolynomials::Node> OrthogonalPolynomials::gauss_rule(int d) const {
  using Matrix =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxDegree + 1, kMaxDegree + 1>;
  const Eigen::Index size = d + 1;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxDegree + 1, 1> diagonal(size);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxDegree + 1, 1> below(size - 1);
  for (Eigen::Index k = 0; k < size; ++k) {
    diagonal[k] = alpha_[static_cast<std::size_t>(k)];
    if (k > 0) {
      below[k - 1] = std::sqrt(beta_[static_cast<std::size_t>(k)]);
    }
  }
  Eigen::SelfAdjointEigenSolver<Matrix> solver(size);
  solver.computeFromTridiagonal(diagonal, below, Eigen::ComputeEigenvectors);
  std::vector<Node> nodes;
  nodes.reserve(static_cast<std::size_t>(size));
  for (Eigen::Index k = 0; k < size; ++k) {
    const double first = solver.eigenvectors()(0, k);
    nodes.push_back({solver.eigenvalues()[k], weight_sum_ * first * first});
  }
  return nodes;
}

}  // namespace palpate
