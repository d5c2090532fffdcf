#include "node/python/sendable.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "node/wire/ingest_limits.h"

namespace palpate {
namespace {

constexpr IngestLimits kLimits;

std::string bounds_text(double lowest, double highest, const char* unit) {
  char text[80];
  std::snprintf(text, sizeof text, "%g to %g %s, else the recognizer rejects it", lowest, highest,
                unit);
  return text;
}

}  // namespace

void check_sendable_lengths(double sigma_m, double tip_radius_m) {
  if (sigma_m != 0.0 && !(sigma_m >= kMinSigma && sigma_m <= kLimits.max_sigma_m)) {
    throw std::invalid_argument("sigma: must be 0 (not known) or " +
                                bounds_text(kMinSigma, kLimits.max_sigma_m, "m"));
  }
  if (!(tip_radius_m >= 0.0 && tip_radius_m <= kLimits.max_tip_radius_m)) {
    throw std::invalid_argument("tip_radius: must be " +
                                bounds_text(0.0, kLimits.max_tip_radius_m, "m"));
  }
}

void check_sendable_points(const Array& points_m, const Array& normals, const Array& normal_sigmas,
                           const Array& covariances_m2) {
  const std::size_t count = count_of_points(points_m);
  const PointDetails details(normals, normal_sigmas, covariances_m2, count);
  for (std::size_t i = 0; i < count; ++i) {
    const double* point = points_m.data() + 2 * i;
    if (!(std::abs(point[0]) <= kLimits.max_coordinate_m &&
          std::abs(point[1]) <= kLimits.max_coordinate_m)) {
      throw std::invalid_argument(
          "points: the coordinates of number " + std::to_string(i) + " must be " +
          bounds_text(-kLimits.max_coordinate_m, kLimits.max_coordinate_m, "m"));
    }
    const SampleDetail detail = details.of(i);
    if (detail.normal_sigma_rad > 0.0 &&
        !(detail.normal_sigma_rad >= kMinNormalSigma && detail.normal_sigma_rad <= kPi)) {
      throw std::invalid_argument("normal_sigma: must be " +
                                  bounds_text(kMinNormalSigma, kPi, "rad"));
    }
    const double least = std::min(detail.covariance_m2.x(), detail.covariance_m2.z());
    const double most = std::max(detail.covariance_m2.x(), detail.covariance_m2.z());
    constexpr double kLeastVariance = kMinSigma * kMinSigma;
    constexpr double kMostVariance = kLimits.max_sigma_m * kLimits.max_sigma_m;
    if (most > 0.0 && !(least >= kLeastVariance && most <= kMostVariance)) {
      throw std::invalid_argument("covariances: the variances of number " + std::to_string(i) +
                                  " must be " + bounds_text(kLeastVariance, kMostVariance, "m^2"));
    }
  }
}

}  // namespace palpate
