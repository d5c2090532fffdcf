// Single touches that hang together: from each to the next no farther than their noise.
#pragma once

#include <cstddef>
#include <vector>

#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// Two touches of one place lie farther apart than this, in standard deviations of the difference
/// of a coordinate, once in a thousand times.
inline constexpr double kOnePlace = 3.72;  // sqrt(2 ln 1000)

/// Standard deviation of the stored touch. [m]
double deviation_m(const StoredSample& touch, double default_sigma_m);

/// Chains of two touches or more, as ascending indices of `patches`; those of no chain are not
/// told. Each touch of a chain lies within kOnePlace of another of the chain and of no other touch.
/// Only touches of one kind of tip, whose normals, if they have any, are one direction, and whose
/// noise is stated (by the samples or `default_sigma_m` [m]). A chain that is too long for one
/// place is not told either: touches lie along it. O(n log n) for touches on a curve.
std::vector<std::vector<std::size_t>> chained_touches(const std::vector<StoredPatch>& patches,
                                                      double default_sigma_m);

}  // namespace palpate
