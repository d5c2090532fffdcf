#include "node/python/patch_arrays.h"

#include <cmath>
#include <stdexcept>

#include "node/python/names.h"

namespace palpate {

PatchArrays::PatchArrays(const Array& points, const Array& sigma_m, std::uint32_t probe,
                         std::uint32_t patch, double tip_radius_m, const std::string& side,
                         const Array& normals, const Array& normal_sigmas,
                         const Array& covariances_m2)
    : count_(count_of_points(points)),
      xy_(points.data()),
      sigma_m_(sigma_m.data()),
      sigmas_(static_cast<std::size_t>(sigma_m.size())),
      context_{probe, patch, tip_radius_m, side_called(side)},
      details_(normals, normal_sigmas, covariances_m2, count_) {
  check_sigmas(sigma_m, count_);
  std::size_t not_finite = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    not_finite += std::isfinite(xy_[2 * i]) && std::isfinite(xy_[2 * i + 1]) ? 0 : 1;
  }
  if (not_finite > 0) {
    throw std::invalid_argument("points: " + std::to_string(not_finite) + " are not finite");
  }
  if (!(std::isfinite(tip_radius_m) && tip_radius_m >= 0.0)) {
    throw std::invalid_argument("tip_radius: must be finite and not below 0");
  }
}

void PatchArrays::copy_to(std::vector<ContactSample>& samples,
                          std::vector<SampleDetail>& details) const {
  samples.resize(count_);
  for (std::size_t i = 0; i < count_; ++i) {
    samples[i].position_m = Vec2(xy_[2 * i], xy_[2 * i + 1]);
    samples[i].sigma_m = sigmas_ == 0 ? 0.0 : sigma_m_[sigmas_ == 1 ? 0 : i];
  }
  details.resize(details_.say_anything() ? count_ : 0);
  for (std::size_t i = 0; i < details.size(); ++i) {
    details[i] = details_.of(i);
    if (details[i].covariance_m2.x() > 0.0) {
      samples[i].sigma_m = mean_sigma_m(details[i].covariance_m2);
    }
  }
}

}  // namespace palpate
