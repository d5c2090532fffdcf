// The place from which a class's curve is seen: its prior is told in coordinates there.
#pragma once

#include <cstddef>

#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Index of the middle point of the longest stretch of a patch that does not turn back: a cusp has
/// no tangent from which a curve could be seen, and next to one it turns round within the noise.
/// The same point in whichever order patches and their points come. `data` must have points.
/// O(points).
std::size_t reference_point(const FitData& data);

}  // namespace palpate
