// Samples that leave the path of their stroke by a jump: what spikes look like before anything is
// fitted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/curves/pose2.h"

namespace palpate {

/// Which samples are far from both neighbours, compared with the short steps of the stroke.
std::vector<std::uint8_t> jumps_of(std::span<const Vec2> samples);

/// Which samples are of a run of at most `longest` that one long step leads to and another leads
/// back from, both longer than what the path goes on by meanwhile: spikes, and samples between
/// them. A bend, a turn, a gap and an uneven speed are none. Spikes at an end and those within four
/// short steps of the path are not told. O(samples * longest).
std::vector<std::uint8_t> detours_of(std::span<const Vec2> samples, std::size_t longest);

}  // namespace palpate
