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

/// Longest run of samples that may all be spikes; four in a row off a curve are a bend. If one
/// sample in 20 is a spike, chance makes four in a row once in 20^4 samples, more than the memory
/// holds.
inline constexpr std::size_t kLongestRunOfSpikes = 3;

/// Which samples are of a run of at most kLongestRunOfSpikes that one long step leads to and
/// another leads back from, both longer than what the path goes on by meanwhile: spikes, and
/// samples between them. A bend, a turn, a gap and an uneven speed are none. Spikes at an end and
/// those within four short steps of the path are not told. Where steps are shorter than the noise,
/// some samples in a hundred are told by chance. O(samples).
std::vector<std::uint8_t> detours_of(std::span<const Vec2> samples);

}  // namespace palpate
