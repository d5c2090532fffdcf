// Two readings of the same samples: some are spikes, or the part runs through them.
#pragma once

#include <span>

#include "core/recognition/counted/weighed.h"
#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// The more probable of two readings, with the probabilities of all classes by both
/// (core/README.md, "Spikes, or a bend through them"). Their noise is stated, and either has a
/// class. What they lack of the samples of `all` is spikes to them. `one` is of `patches` unless it
/// has its own, as `other` does. Where both are of one class and differ, the share of the reading
/// that is not told counts as that of a spline's rival.
Weighed more_probable(Weighed one, Weighed other, std::span<const StoredPatch> patches,
                      std::span<const StoredPatch> all);

}  // namespace palpate
