// Least-squares polynomials over a set of weighted abscissae, and the Gauss quadrature of that set.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace palpate {

/// Weighted least squares by discrete orthogonal polynomials (G. E. Forsythe, "Generation and use
/// of orthogonal polynomials for data-fitting with a digital computer", 1957). One sweep per degree
/// gives the fits of all degrees, without normal equations. O(points * degree).
class OrthogonalPolynomials {
 public:
  static constexpr int kMaxDegree = 9;

  struct Value {
    double value = 0.0;
    double derivative = 0.0;  ///< derivative of the fit by x
  };

  struct Node {
    double x = 0.0;
    double weight = 0.0;
  };

  /// Fits y(x) with weights w, for all degrees up to `degree`, which must be below the number of
  /// distinct x.
  OrthogonalPolynomials(std::span<const double> x, std::span<const double> w,
                        std::span<const double> y, int degree);

  /// As of y times this, and of weights times that.
  void rescale(double of_y, double of_w);

  int degree() const { return degree_; }

  /// Weighted sum of squared residuals of the fit of degree d.
  double residual_sum(int d) const { return residual_sum_[static_cast<std::size_t>(d)]; }

  /// The fit of degree d at x.
  Value evaluate(double x, int d) const;

  /// Variance of the slope of the fit of degree d at x, if the weights are inverse variances.
  double slope_variance(double x, int d) const;

  /// The d + 1 nodes and weights that integrate polynomials up to degree 2 d + 1 exactly over the
  /// weighted abscissae: sum_i w_i p(x_i) = sum_k W_k p(X_k). They are the eigenvalues of the
  /// Jacobi matrix of the recurrence (G. Golub and J. Welsch, 1969). Ascending x.
  std::vector<Node> gauss_rule(int d) const;

 private:
  /// Calls visit(k, p_k(x), p_k'(x)) for k = 0 ... d.
  template <typename Visit>
  void for_each_polynomial(double x, int d, const Visit& visit) const;

  static constexpr std::size_t kSize = kMaxDegree + 1;
  int degree_ = 0;
  double weight_sum_ = 0.0;
  std::array<double, kSize> alpha_{};  ///< p_{k+1} = (x - alpha_k) p_k - beta_k p_{k-1}
  std::array<double, kSize> beta_{};
  std::array<double, kSize> coefficient_{};
  std::array<double, kSize> residual_sum_{};
};

}  // namespace palpate
