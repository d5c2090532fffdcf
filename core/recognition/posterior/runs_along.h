// Orders points along a curve, so that neighbours with common errors are adjacent.
#pragma once

#include <span>
#include <vector>

#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

struct Runs {
  std::vector<PatchSpan> spans;    ///< ranges of `order`
  std::vector<std::size_t> order;  ///< indices of the points, each once
};

/// Each patch is a run, in the order of the stroke. All single touches, which have no order of
/// their own, are one run, in the order of their places on the fitted curve.
Runs runs_along(const CanonicalFit& placed, std::span<const PatchSpan> patches);

}  // namespace palpate
