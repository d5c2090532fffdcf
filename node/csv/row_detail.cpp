#include "node/csv/row_detail.h"

#include "node/wire/ingest_limits.h"

namespace palpate::csv {
namespace {

// What the node would refuse is not used offline either.
constexpr double kLeastVarianceM2 = kMinSigma * kMinSigma;
constexpr double kMostVarianceM2 = IngestLimits{}.max_sigma_m * IngestLimits{}.max_sigma_m;

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
      numbers.normal_sigma_rad >= kMinNormalSigma && numbers.normal_sigma_rad <= kPi;
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
