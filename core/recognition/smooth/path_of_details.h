// Where the smooth model's path leads by samples of which a probe says more than their noise.
#pragma once

#include "core/recognition/samples/fit_data.h"
#include "core/recognition/smooth/section_fit.h"

namespace palpate {

/// Sets `travel` and `off_path` of the details of a section's points. O(points).
void tell_path(const SectionFit& fit, FitData* data);

}  // namespace palpate
