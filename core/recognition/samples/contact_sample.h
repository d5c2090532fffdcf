// What a probe delivers: contact samples and their patch.
#pragma once

#include <cstdint>

#include "core/curves/pose2.h"

namespace palpate {

/// Side of the direction of travel on which the material lies.
enum class MaterialSide { Unspecified, Left, Right };

/// Where round tips touch a part if neither their probe nor a measured normal tells the side:
/// outside its bends (a pin, a boss), inside them (a bore), or one of these.
enum class TouchedFrom { Unknown, Outside, Inside };

struct ContactSample {
  Vec2 position_m = Vec2::Zero();
  double sigma_m = 0.0;       ///< 1-sigma isotropic position noise; 0 = not known [m]
  std::int64_t stamp_ns = 0;  ///< time of the sample; core does not use it [ns]
};

/// Where samples belong: a patch is one unbroken touch of one probe. A patch of a single sample is
/// a single touch: it has no direction of travel, so that its material side says nothing.
struct PatchContext {
  std::uint32_t probe = 0;
  std::uint32_t patch = 0;
  /// The samples are centres of a round tip of this radius; 0 = surface points. [m]
  double tip_radius_m = 0.0;
  MaterialSide material_side = MaterialSide::Unspecified;

  bool operator==(const PatchContext&) const = default;
};

/// Whether samples continue a stroke. What is said of its tip holds for all of it: another radius,
/// or the other side, is of another stroke that has the same number.
inline bool is_of_one_stroke(const PatchContext& stroke, const PatchContext& more) {
  const bool same_side = stroke.material_side == more.material_side ||
                         stroke.material_side == MaterialSide::Unspecified ||
                         more.material_side == MaterialSide::Unspecified;
  return stroke.probe == more.probe && stroke.patch == more.patch &&
         stroke.tip_radius_m == more.tip_radius_m && same_side;
}

/// What is said of a stroke that samples continue: they may state a side that nothing stated yet.
inline PatchContext continued(PatchContext stroke, const PatchContext& more) {
  if (stroke.material_side == MaterialSide::Unspecified) {
    stroke.material_side = more.material_side;
  }
  return stroke;
}

}  // namespace palpate
