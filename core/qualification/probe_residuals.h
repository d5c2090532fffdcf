// What qualified probes leave of a curve that fits.
#pragma once

#include <span>

#include "core/qualification/probe_correction.h"

namespace palpate {

/// The chi-square, with the inverse variances of the white noise, that the probes' white noise and
/// their coherent deviation exceed with kNegligibleProbability at most. `dof`: of the fit, whose
/// residuals are not asked how much of the deviation they have taken: it only makes chi-square
/// less. Patches without a file have white noise alone. O(samples).
double most_chi2_of_probes(std::span<const ProbedPatch> patches, int dof);

}  // namespace palpate
