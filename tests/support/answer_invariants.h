// What every answer must keep, whatever the input.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/recognition/recognition.h"

namespace palpate::test {

/// Fewest distinct places that a RECOGNIZED answer may rest on: two more than its class has
/// parameters, and no fewer than a spline has; eight for no class.
std::size_t fewest_places(CurveClass curve_class);

/// What an answer rests on.
struct TouchedPlaces {
  std::size_t distinct = 0;
  /// Largest distance from the middle of their bounding box is no more than what rounding makes of
  /// their coordinates.
  bool at_rounding = false;
};

TouchedPlaces places_of(std::span<const Vec2> positions);

/// The first invariant that the answer breaks, in words; empty where it keeps all:
/// probabilities in [0, 1] that sum to 1 within 1e-9, no NaN; covariances symmetric and positive
/// semidefinite to rounding where their entries are finite; contacts finite; never RECOGNIZED from
/// fewer distinct places than its class asks for, nor where the extent is at rounding; no more work
/// than is allowed, and where that was not enough, AMBIGUOUS for it.
std::string broken_invariant(const Recognition& answer, const TouchedPlaces& places);

}  // namespace palpate::test
