// Finds the side of the patches on which the material lies, for round tips without a stated side.
#pragma once

#include <span>

#include "core/recognition/samples/sample_memory.h"
#include "core/recognition/weigh/side_choice.h"
#include "core/recognition/weigh/sided_fits.h"
#include "core/recognition/weigh/sided_start.h"

namespace palpate {

/// Fits the classes to the reduced points and chooses the sides of the tips. If sides are not
/// known, it takes the choice of highest evidence; the expected one has the odds of the prior.
/// `starts`: as in weigh().
SidedFits fit_over_sides(std::span<const StoredPatch> patches, const SideContext& by,
                         std::span<const SidedStart> starts);

/// Compares the choices of sides again under another likelihood than they were fitted by, if sides
/// are open: a deviation that is more than noise also makes sides harder to tell. The fits stay,
/// because least squares are the same under both. (Classes out of reach under the first likelihood
/// stay out: their residuals exceed the largest noise of both.) Returns whether the choice changed.
bool rejudge_sides(const SideContext& by, SidedFits* sided);

}  // namespace palpate
