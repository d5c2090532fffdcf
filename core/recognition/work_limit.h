// How much work an answer may take.
#pragma once

#include <cstddef>
#include <span>

#include "core/numerics/work_budget.h"
#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Work that a clean ellipse of so many samples in so many patches takes, at most.
double work_of_clean_ellipse(std::size_t samples, std::size_t patches);

/// What an answer on these patches may take; that their samples are read is counted.
WorkBudget work_limit(std::span<const StoredPatch> patches);

}  // namespace palpate
