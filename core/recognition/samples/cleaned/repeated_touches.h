// Single touches that repeat one place.
#pragma once

#include <vector>

#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Two touches of one place lie farther apart than this, in standard deviations of the difference
/// of a coordinate, once in a thousand times.
inline constexpr double kOnePlace = 3.72;  // sqrt(2 ln 1000)

/// The patches, with single touches of one place replaced by their mean, which weighs as all of
/// them: a place touched again tells where it is, and nothing more of the curve. Only touches of
/// one kind of tip whose noise is stated (by the samples or `default_sigma_m` [m]), and only as
/// many as scatter no more than that noise. Touches that lie so close along a curve have a mean
/// that is as near to it, unless it bends within their noise. The mean stands where the first of
/// them was. O(n log n) for touches that lie apart.
std::vector<StoredPatch> without_repeated_touches(std::vector<StoredPatch> patches,
                                                  double default_sigma_m);

}  // namespace palpate
