// Recordings of a part as a probe file says that they come out: what its regions are to hold.
#pragma once

#include <random>
#include <vector>

#include "core/qualification/qualify.h"

namespace palpate::bench {

/// The contacts of a recording with other errors: taken to where the tip's centre would be on the
/// part, and off again by an offset, a drift and noise drawn from what the file leaves possible.
/// Spikes stay. `on_part`: the recording beside the part that it is of, one stroke.
std::vector<Vec2> simulated(const std::vector<Vec2>& contacts, const Qualification& on_part,
                            const ProbeCharacter& probe, std::mt19937_64& rng);

}  // namespace palpate::bench
