#include "node/python/point_details.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace palpate {

namespace py = pybind11;

std::size_t count_of_points(const Array& points) {
  if (points.ndim() != 2 || points.shape(1) != 2) {
    throw std::invalid_argument("points must be an array of shape (n, 2)");
  }
  return static_cast<std::size_t>(points.shape(0));
}

void check_sigmas(const Array& sigma, std::size_t points) {
  const auto count = static_cast<std::size_t>(sigma.size());
  if (count > 1 && count != points) {
    throw std::invalid_argument("sigma must be one number, or one a point");
  }
  if (!std::all_of(sigma.data(), sigma.data() + count,
                   [](double value) { return std::isfinite(value) && value >= 0.0; })) {
    throw std::invalid_argument("sigma: must be finite and not below 0");
  }
}

PointDetails::PointDetails(const Array& normals, const Array& normal_sigmas,
                           const Array& covariances, std::size_t points)
    : normals_(normals.size() > 0 ? normals.data() : nullptr),
      normal_sigmas_(normal_sigmas.data()),
      covariances_(covariances.size() > 0 ? covariances.data() : nullptr),
      one_sigma_(normal_sigmas.size() == 1),
      one_covariance_(covariances.ndim() == 2) {
  const auto count = static_cast<py::ssize_t>(points);
  if (normals_ != nullptr &&
      (normals.ndim() != 2 || normals.shape(0) != count || normals.shape(1) != 2)) {
    throw std::invalid_argument("normals must be an array of shape (n, 2), one for each point");
  }
  const py::ssize_t sigmas = normal_sigmas.size();
  if ((normals_ != nullptr) != (sigmas > 0) || (sigmas > 1 && sigmas != count)) {
    throw std::invalid_argument("normal_sigma must be one number, or one for each normal");
  }
  if (covariances_ != nullptr) {
    const py::ssize_t dimensions = covariances.ndim();
    if ((dimensions != 2 && dimensions != 3) || covariances.shape(dimensions - 1) != 2 ||
        covariances.shape(dimensions - 2) != 2 ||
        (dimensions == 3 && covariances.shape(0) != count)) {
      throw std::invalid_argument("covariances must be an array of shape (2, 2) or (n, 2, 2)");
    }
  }
  for (std::size_t i = 0; i < points; ++i) check(i);
}

SampleDetail PointDetails::of(std::size_t i) const {
  SampleDetail detail;
  if (normals_ != nullptr) {
    detail.normal = Vec2(normals_[2 * i], normals_[2 * i + 1]);
    if (!detail.normal.isZero(0.0)) {
      detail.normal = as_unit(detail.normal);
      detail.normal_sigma_rad = normal_sigmas_[one_sigma_ ? 0 : i];
    }
  }
  if (covariances_ != nullptr) {
    const double* c = covariances_ + (one_covariance_ ? 0 : 4 * i);
    detail.covariance_m2 = {c[0], c[1], c[3]};
  }
  return detail;
}

void PointDetails::check(std::size_t i) const {
  if (normals_ != nullptr) {
    const Vec2 normal(normals_[2 * i], normals_[2 * i + 1]);
    const double sigma = normal_sigmas_[one_sigma_ ? 0 : i];
    if (!normal.isZero(0.0) && !is_unit(normal)) {
      throw std::invalid_argument("normals: number " + std::to_string(i) +
                                  " is neither of length 1 nor (0, 0)");
    }
    if (!(std::isfinite(sigma) && sigma >= 0.0) || (!normal.isZero(0.0) && sigma == 0.0)) {
      throw std::invalid_argument("normal_sigma: must be finite and above 0");
    }
  }
  if (covariances_ != nullptr) {
    const double* c = covariances_ + (one_covariance_ ? 0 : 4 * i);
    constexpr double kRounding = 1e-12;  // rounding of the products that a covariance consists of
    if (!is_covariance({c[0], c[1], c[3]}) ||
        std::abs(c[1] - c[2]) > kRounding * std::sqrt(c[0] * c[3])) {
      throw std::invalid_argument("covariances: number " + std::to_string(i) +
                                  " is not symmetric and positive definite");
    }
  }
}

}  // namespace palpate
