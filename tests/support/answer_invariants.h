// Invariants that every answer must satisfy, whatever the input.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/recognition/recognition.h"

namespace palpate::test {

/// Fewest distinct places of a RECOGNIZED answer: two more than its class has parameters, and no
/// fewer than a spline has; eight for no class.
std::size_t fewest_places(CurveClass curve_class);

/// The places that an answer is based on.
struct TouchedPlaces {
  std::size_t distinct = 0;
  /// True if their largest distance from the middle of their bounding box is no more than the
  /// rounding of their coordinates.
  bool at_rounding = false;
};

TouchedPlaces places_of(std::span<const Vec2> positions);

/// Describes the first invariant that the answer violates; empty if there is none. The invariants:
/// probabilities are in [0, 1] and sum to 1 within 1e-9, nothing is NaN; covariances are symmetric
/// and, where their entries are finite, positive semidefinite to rounding; contacts are finite; an
/// answer is not RECOGNIZED from fewer distinct places than its class needs, nor if the extent is
/// at rounding.
std::string broken_invariant(const Recognition& answer, const TouchedPlaces& places);

}  // namespace palpate::test
