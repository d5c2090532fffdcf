// Samples that were taken for spikes before any class was known, and are none by the curve that was
// found.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/curves/curve.h"
#include "core/recognition/samples/sample_memory.h"

namespace palpate {

/// The patches of `clean` with those of `all` taken back that lie on the curve within `limit`
/// standard deviations (a tip's centre: within them of its radius away), at a place that the stroke
/// passed between the samples before and after: a bend sharper than the spacing looks like a spike,
/// and neighbours of spikes are suspected with them. `noise_m` is that of samples which bring none.
/// nullopt where there are none to take back. Each patch of `clean` is
/// a subsequence of its patch in `all`.
std::optional<std::vector<StoredPatch>> with_explained_spikes(std::span<const StoredPatch> all,
                                                              std::span<const StoredPatch> clean,
                                                              const Curve& curve,
                                                              const Pose2& world_T_curve,
                                                              double noise_m, double limit);

}  // namespace palpate
