#include "core/qualification/normal_offset.h"

#include <algorithm>
#include <cmath>

namespace palpate {

Eigen::RowVectorXd offset_basis(double phi, int order) {
  Eigen::RowVectorXd basis(offset_coefficients(order));
  set_harmonics(Vec2(std::cos(phi), std::sin(phi)), order, &basis);
  return basis;
}

Eigen::RowVectorXd offset_basis_slope(double phi, int order) {
  Eigen::RowVectorXd slope(offset_coefficients(order));
  slope[0] = 0.0;
  for (int k = 2; k <= order; ++k) {
    slope[first_offset_of(k)] = -k * std::sin(k * phi);
    slope[first_offset_of(k) + 1] = k * std::cos(k * phi);
  }
  return slope;
}

Eigen::RowVectorXd offset_basis_bend(double phi, int order) {
  Eigen::RowVectorXd bend = -offset_basis(phi, order);
  bend[0] = 0.0;
  for (int k = 2; k <= order; ++k) {
    bend.segment<2>(first_offset_of(k)) *= k * k;
  }
  return bend;
}

double largest_lobe_m(const NormalOffset& offset) {
  double largest = 0.0;
  for (int k = 2; k <= offset.order; ++k) {
    largest = std::max(largest, std::hypot(offset.coefficients_m[first_offset_of(k)],
                                           offset.coefficients_m[first_offset_of(k) + 1]));
  }
  return largest;
}

double mean_square_of_lobes(const NormalOffset& offset) {
  return 0.5 * offset.coefficients_m.tail(offset.coefficients_m.size() - 1).squaredNorm();
}

double mean_variance_of_lobes(const NormalOffset& offset) {
  return 0.5 * offset.covariance_m2.diagonal().tail(offset.covariance_m2.rows() - 1).sum();
}

double offset_at(const NormalOffset& offset, double phi) {
  return offset_basis(phi, offset.order).dot(offset.coefficients_m);
}

double offset_deviation_at(const NormalOffset& offset, double phi) {
  const Eigen::RowVectorXd basis = offset_basis(phi, offset.order);
  return std::sqrt(std::max(0.0, (basis * offset.covariance_m2).dot(basis)));
}

}  // namespace palpate
