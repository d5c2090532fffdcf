// Spikes in sharp bends, where nothing but a class tells them from the bend.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/recognition/counted/weighed.h"
#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Of the curve of a class that leaves no more than noise of some samples, and of these.
using CurveOfOthers =
    std::function<bool(const ExplainingCurve&, std::span<const StoredPatch> others)>;

/// The patches without the samples of strokes that no polynomial follows, or only because it bends
/// to them: those in a bend sharper than they are apart, or a spike there, which no block of the
/// spikes' search judges.
/// `weighing`: of the patches' samples without the flagged ones. nullopt if there are none, if
/// they are more than an eighth of all, or if no class fits the others, or none whose curve
/// `matters`.
std::optional<std::vector<StoredPatch>> without_unfollowed(const Weighing& weighing,
                                                           const std::vector<bool>& flagged,
                                                           std::span<const StoredPatch> patches,
                                                           const CurveOfOthers& matters,
                                                           WorkBudget& work);

/// Whether what `left` lacks of the samples of `all` may be spikes: no more than a class may set
/// aside, and no longer runs (stored_spikes.h). Patches correspond; their order is the same.
bool may_lack_spikes(std::span<const StoredPatch> all, std::span<const StoredPatch> left);

}  // namespace palpate
