#pragma once

#include <pybind11/numpy.h>

#include <cstddef>

#include "core/recognition/samples/sample_detail.h"

namespace palpate {

using Array = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// Number of points. Throws std::invalid_argument unless the shape is (n, 2).
std::size_t count_of_points(const Array& points);

/// Throws std::invalid_argument unless `sigma` is one number or one per point, each finite and at
/// least 0; it may be empty.
void check_sigmas(const Array& sigma, std::size_t points);

/// Optional data of points besides their positions; reads numpy's memory without a copy.
class PointDetails {
 public:
  /// Each array may be empty. `normals`: (n, 2), unit vectors, (0, 0) where none was measured.
  /// `normal_sigmas`: 1 or n standard deviations, in radians. `covariances`: (2, 2) or (n, 2, 2).
  /// Throws std::invalid_argument that names the problem.
  PointDetails(const Array& normals, const Array& normal_sigmas, const Array& covariances,
               std::size_t points);

  bool say_anything() const { return normals_ != nullptr || covariances_ != nullptr; }

  SampleDetail of(std::size_t i) const;

 private:
  void check(std::size_t i) const;

  const double* normals_;
  const double* normal_sigmas_;
  const double* covariances_;
  bool one_sigma_;
  bool one_covariance_;
};

}  // namespace palpate
