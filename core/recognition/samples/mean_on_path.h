// Means of contacts, moved from inside a bend onto the path.
#pragma once

#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Where the path is in the middle of the contacts that a stored sample is the mean of: the mean
/// itself lies inside a bend, by kappa w^2 / 24 over an arc w. That is little, but the same along
/// the whole stroke, and so many contacts tell the path much better. The sample's own place where
/// it stands for one contact, for a dwell, or too few lie about it to show a bend. [m]
Vec2 mean_on_path(const StoredPatch& patch, std::size_t i);

}  // namespace palpate
