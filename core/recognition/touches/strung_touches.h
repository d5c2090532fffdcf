// Touches one at a time, strung into runs along the curve where they lie close enough.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/recognition/fit/warm_start.h"
#include "core/recognition/samples/sample_memory.h"

namespace palpate {

struct StrungTouches {
  std::vector<StoredPatch> patches;
  /// Every class as it fits the touches that the order was sought through, tips' centres where they
  /// are round; sides all 0. Empty where no curve was sought, no cubic, or none that fits.
  std::vector<SidedStart> starts;
};

/// `patches` with those of a single sample that lie densely along the curve taken together, in
/// their order along it, as patches of their own at the end: from then on they are like strokes,
/// with local geometry, a noise that shows and few reduced points. The order comes from the curve
/// that explains the touches best; a run turns so little from touch to touch that a polynomial
/// follows it. Touches of different tips are not mixed. A run has the name of its first touch, and
/// no side that a probe could have said. nullopt where there is no run. `default_sigma_m`: of
/// samples that bring none; `classes`: by bit 1 << CurveClass.
std::optional<StrungTouches> strung_touches(std::span<const StoredPatch> patches,
                                            double default_sigma_m, unsigned classes,
                                            WorkBudget& work);

}  // namespace palpate
