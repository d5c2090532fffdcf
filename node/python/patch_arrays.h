#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/recognition/samples/contact_sample.h"
#include "core/recognition/samples/sample_detail.h"
#include "node/python/point_details.h"

namespace palpate {

/// One patch as Python gives it; reads numpy's memory without a copy.
class PatchArrays {
 public:
  /// `points`: n x 2, in metres. `sigma_m`: length n, 1 or 0. The others as in PointDetails. Throws
  /// std::invalid_argument that names the problem.
  PatchArrays(const Array& points, const Array& sigma_m, std::uint32_t probe, std::uint32_t patch,
              double tip_radius_m, const std::string& side, const Array& normals,
              const Array& normal_sigmas, const Array& covariances_m2);

  std::size_t size() const { return count_; }
  const PatchContext& context() const { return context_; }

  /// `details` are empty where no point has any. Needs no interpreter.
  void copy_to(std::vector<ContactSample>& samples, std::vector<SampleDetail>& details) const;

 private:
  std::size_t count_;
  const double* xy_;
  const double* sigma_m_;
  std::size_t sigmas_;
  PatchContext context_;
  PointDetails details_;
};

}  // namespace palpate
