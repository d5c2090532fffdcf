// Takes back samples that were removed as spikes before the curve was known: those that lie on it,
// and the ends of strokes that may.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/curves/curve.h"
#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// The patches of `clean`, with the samples of `all` added that the curve explains. Such a sample
/// lies on the curve within `limit` standard deviations (a tip's centre: at the tip radius from
/// it), at a place that the stroke passed between the samples before and after. Reason: a bend
/// sharper than the sample spacing looks like a spike, and neighbours of spikes are suspected too.
/// `noise_m`: noise of samples that state none [m]. Each patch of `clean` must be a subsequence of
/// its patch in `all`. nullopt if there is nothing to add.
std::optional<std::vector<StoredPatch>> with_explained_spikes(std::span<const StoredPatch> all,
                                                              std::span<const StoredPatch> clean,
                                                              const Curve& curve,
                                                              const Pose2& world_T_curve,
                                                              double noise_m, double limit);

/// The patches of `clean`, with the runs of two samples and more added with which a patch of `all`
/// begins or ends and of which none is left, if their steps are no longer than those between
/// neighbours that are kept: an arm of a cusp by few samples leaves the path of the rest as spikes
/// do, but spikes leap. nullopt if there are none.
std::optional<std::vector<StoredPatch>> with_runs_at_ends(std::span<const StoredPatch> all,
                                                          std::span<const StoredPatch> clean);

}  // namespace palpate
