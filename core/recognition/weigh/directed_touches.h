// Reduced points of round tips with directions, bends and travel, before any side is assumed.
#pragma once

#include <span>
#include <vector>

#include "core/recognition/samples/fit_data.h"
#include "core/recognition/samples/stored_patch.h"
#include "core/recognition/weigh/curve_of_centres.h"
#include "core/recognition/weigh/side_choice.h"

namespace palpate {

/// The reduced points with directions for those that show none, the sides to which the patches
/// bend, and how they travel along the curve of the centres where that was needed.
struct DirectedTouches {
  FitData touches;
  std::vector<double> bends;
  std::vector<double> senses;
  bool told;  ///< of SideContext::directions_told
};

/// Whether tips are of different radii: then their centres lie on different curves.
bool have_other_radii(const FitData& touches);

/// Whether the way of each tip is seen.
bool are_strokes(const FitData& touches);

/// What the tips do not show by themselves comes from edges that their centres lie on, or from the
/// curve of these.
DirectedTouches directed_touches(std::span<const StoredPatch> patches, const SideContext& by,
                                 CurveOfCentres* centres);

}  // namespace palpate
