// Points in the order in which they lie along a curve: what errs together are neighbours.
#pragma once

#include <span>
#include <vector>

#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

struct Runs {
  std::vector<PatchSpan> spans;    ///< of `order`
  std::vector<std::size_t> order;  ///< the points, each once
};

/// Patches as they were stroked; the touches alone in their patch, which have no order of their
/// own, as one run by their places on the curve that was fitted to the points.
Runs runs_along(const CanonicalFit& placed, std::span<const PatchSpan> patches);

}  // namespace palpate
