#include "node/csv/row_detail.h"

namespace palpate::csv {
namespace {

// The bounds of node/intake/ingest.h: what the node would refuse is not used offline either.
constexpr double kLeastNormalSigmaRad = 1e-15;
constexpr double kLeastVarianceM2 = 1e-30;
constexpr double kMostVarianceM2 = 1e6;

}  // namespace

std::string_view words_of(DetailFault fault) {
  switch (fault) {
    case DetailFault::None:
      return "";
    case DetailFault::NormalLength:
      return "a normal is of unit length";
    case DetailFault::NormalDeviation:
      return "a normal needs its deviation";
    case DetailFault::Covariance:
      return "cov_xx, cov_xy, cov_yy are no positive definite covariance";
  }
  return "";
}

DetailFault take_detail(const DetailNumbers& numbers, ContactRow& row) {
  const bool has_normal = !numbers.normal.isZero(0.0) || numbers.normal_sigma_rad != 0.0;
  if (has_normal && !is_unit(numbers.normal)) return DetailFault::NormalLength;
  const bool has_deviation =
      numbers.normal_sigma_rad >= kLeastNormalSigmaRad && numbers.normal_sigma_rad <= kPi;
  if (has_normal && !has_deviation) return DetailFault::NormalDeviation;
  const Eigen::Vector3d& covariance = numbers.covariance_m2;
  const bool has_covariance = !covariance.isZero(0.0);
  if (has_covariance &&
      (!is_covariance(covariance) || covariance.x() < kLeastVarianceM2 ||
       covariance.z() < kLeastVarianceM2 || covariance.maxCoeff() > kMostVarianceM2)) {
    return DetailFault::Covariance;
  }
  if (has_normal) {
    row.detail.normal = as_unit(numbers.normal);
    row.detail.normal_sigma_rad = numbers.normal_sigma_rad;
  }
  if (has_covariance) {
    row.detail.covariance_m2 = covariance;
    row.sample.sigma_m = mean_sigma_m(covariance);
  }
  return DetailFault::None;
}

}  // namespace palpate::csv
