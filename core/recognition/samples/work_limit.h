// How much work an answer may take.
#pragma once

#include <cstddef>
#include <span>

#include "core/numerics/work_budget.h"
#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// All that an answer may take, over the work of a clean ellipse. A planner can wait for eight, by
/// the clock. An answer that is cut has spent five and a third of these, and takes up to half
/// longer than its count says (`bench_worst_case`). Strokes that go there and back six times, with
/// a noise that nobody states, are recognised within it (habits_test); half a one is for the
/// covariance (recognizer.cpp).
inline constexpr double kMostWork = 6.5;

/// Times that, for samples that are all there and are asked about once, as those of a file: nobody
/// notices whether 64 clean ellipses have taken their time or one, as long as both are tenths of a
/// second. (Of ten thousand samples they are half of one.)
inline constexpr double kPatienceWithFiles = 8.0;

/// Work that a clean ellipse of so many samples in so many patches takes, at most.
double work_of_clean_ellipse(std::size_t samples, std::size_t patches);

/// What an answer on these patches may take; that their samples are read is counted. `patience`:
/// times kMostWork.
WorkBudget work_limit(std::span<const StoredPatch> patches, double patience);

}  // namespace palpate
