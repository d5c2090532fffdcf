#include "node/check/normal_check.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

/// Measured normals beside the direction of travel.
struct NormalsSeen {
  std::size_t judged = 0;
  double along = 0.0;          ///< sum of |cosine| of the angle to the travel
  double into_material = 0.0;  ///< sum of cosines of the angle to where the material is stated
  std::size_t with_side = 0;   ///< judged where a side is stated
};

void look_at_normals(const CheckedPatch& patch, NormalsSeen* seen) {
  const std::size_t n = patch.normals.size();
  // A chord of a tenth of the patch: noise hardly turns it, and the curve is not yet far from it.
  const std::size_t reach = std::max<std::size_t>(n / 20, 1);
  for (std::size_t i = 0; n > 1 && i < n; ++i) {
    const Vec2 travel =
        patch.positions[std::min(i + reach, n - 1)] - patch.positions[i > reach ? i - reach : 0];
    if (patch.normals[i].isZero(0.0) || travel.isZero(0.0)) continue;
    const Vec2 along = travel.normalized();
    ++seen->judged;
    seen->along += std::abs(along.dot(patch.normals[i]));
    if (patch.material_side == MaterialSide::Unspecified) continue;
    const double side = patch.material_side == MaterialSide::Left ? 1.0 : -1.0;
    ++seen->with_side;
    seen->into_material += side * left_of(along).dot(patch.normals[i]);
  }
}

}  // namespace

void judge_normals(const std::string& probe, const std::vector<CheckedPatch>& patches,
                   std::vector<Finding>* findings) {
  NormalsSeen seen;
  for (const CheckedPatch& patch : patches) look_at_normals(patch, &seen);
  if (seen.judged == 0) return;
  // Between across the travel, where this is 0 but for noise, and along it, where it is 1.
  constexpr double kAlong = 0.7;
  constexpr double kInto = 0.5;  // of -1 for all right and 1 for all wrong
  if (seen.along > kAlong * static_cast<double>(seen.judged)) {
    findings->push_back({Severity::Error, probe, "the measured normals lie along the travel",
                         "normal_x and normal_y are the surface's normal in the frame of the "
                         "positions: are these tangents, or in a frame of the probe's own?",
                         true});
  } else if (seen.into_material > kInto * static_cast<double>(seen.with_side)) {
    findings->push_back({Severity::Error, probe,
                         "the measured normals point to where material_side puts the material",
                         "normals point out of the material; material_side is that of the "
                         "direction of travel",
                         true});
  } else {
    findings->push_back({Severity::Note, probe,
                         std::to_string(seen.judged) + " measured normals, across the travel",
                         "as it should be"});
  }
}

}  // namespace palpate
