// At how many different places a part must be touched before an answer says so much.
#pragma once

#include <cstddef>

#include "core/curves/curve_class.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// As many places must speak for or against a class as are left over by its parameters: two. By
/// chance they lie so near to a curve of it with a probability of about the square of the noise
/// over their extent.
inline constexpr std::size_t kFewestLeftOver = 2;

/// Fewer leave a class, the spline, a family of curves through all of them: it has no evidence that
/// the others' could be compared with.
inline constexpr std::size_t kFewestCompared = 6;

/// Fewer places than this fit almost anything where nobody states the noise, or no class is named.
/// A spline takes six, and two speak for or against it.
inline constexpr std::size_t kFewestPlaces = kFewestCompared + kFewestLeftOver;

/// From so many patches that lie apart there is an answer all the same, if an AMBIGUOUS one: what
/// could be, and where it would lie. A circle takes three, and one speaks for or against it.
inline constexpr std::size_t kFewestPatches = 4;

/// Whether the points lie at so many different places. `touch_sigma`: noise, normalised, beyond
/// which single touches must lie apart (repeated_touches.h); 0 where those of one place are merged.
bool have_places(const FitData& data, std::size_t count, double touch_sigma = 0.0);

/// At how many a class can be RECOGNIZED, by evidence and of stated noise.
std::size_t fewest_places(CurveClass curve_class);

}  // namespace palpate
