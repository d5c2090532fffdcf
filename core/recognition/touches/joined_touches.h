// Joins single touches that lie densely along the curve into runs.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/recognition/fit/warm_start.h"
#include "core/recognition/samples/sample_memory.h"

namespace palpate {

struct JoinedTouches {
  std::optional<std::vector<StoredPatch>> patches;  ///< nullopt if there is no run
  /// Fits of every class to the tip centres that were used to find the order: of a search that need
  /// not be made again. Only if that came from a curve and cubics were among the classes; and where
  /// it was made with other points than `patches`, only if the noise is stated and a class fits.
  std::optional<WarmStart> start;
};

/// `patches`, with single touches (patches of one sample) that lie densely along the curve joined
/// into runs. The runs are patches at the end of the list, their samples in order along the curve.
/// Like strokes, they have local geometry, visible noise and few reduced points.
///
/// The order is that of the shortest way through the touches or, if that is in doubt, that along
/// the curve that explains them best. In a run the curve turns so little from touch to touch that a
/// polynomial follows it. Touches of different tip radii are not mixed. A run has the probe and
/// patch number of its first touch and no material side.
/// `default_sigma_m`: noise of samples that state none [m]. `classes`: bit 1 << CurveClass of each.
JoinedTouches joined_touches(std::span<const StoredPatch> patches, double default_sigma_m,
                             unsigned classes, WorkBudget& work);

}  // namespace palpate
