// What is stated of the noise of one sample of a patch beside that of another.
#pragma once

#include <vector>

#include "core/local/residual_block.h"
#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// The noise of each sample across and along the way of the stroke there, over the median of what
/// it is across. Form is no noise that differs: `form_deviation_m` is added to each in quadrature.
/// Empty where all are the same, or one is neither stated nor `default_sigma_m` (0: not known), or
/// none across the way.
std::vector<RelativeNoise> relative_noise(const StoredPatch& patch, double default_sigma_m,
                                          double form_deviation_m);

}  // namespace palpate
