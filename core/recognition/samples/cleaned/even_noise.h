// Samples whose noise is longer one way, seen where it is not.
#pragma once

#include <optional>
#include <vector>

#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// The samples of a patch, in a plane that is stretched so that their noise is as long in every
/// direction: by the mean of their covariances, as seen from the first of them. A smooth path is a
/// smooth one there, and where it turns back it does; but noise that is longer along it than across
/// no longer looks like samples out of order. nullopt where no sample has a covariance.
std::optional<std::vector<StoredSample>> with_even_noise(const StoredPatch& patch);

}  // namespace palpate
