// Ends of a stroke that run straight and leave the rest at a corner: the approach to a part and the
// retract from it, recorded as if they were touches.
#pragma once

#include <cstddef>
#include <span>

#include "core/curves/pose2.h"

namespace palpate {

struct StraightEnd {
  std::size_t samples = 0;  ///< 0 = this end is none
  double corner_rad = 0.0;  ///< by which the travel turns where it meets the rest
};

struct StraightEnds {
  StraightEnd first;
  StraightEnd last;
};

/// The straight ends of a stroke, in its order of travel. A part may have an edge and a corner of
/// its own: whether such an end is an approach, geometry cannot tell. But an end is named only if
///
/// - it has 6 samples or more, and at most a quarter of the stroke;
/// - it is as straight as the noise of the rest lets it be, and straighter than the arm of a cusp;
/// - the corner turns by 60 to 120 degrees, and three times as far as the rest turns between any
///   neighbours. So none is named of a stroke over a cusp.
///
/// Spikes, dwells and repeats may be among the samples. Where the noise is more than an eighth of a
/// step, nothing is named: a corner would not differ from a fillet. O(samples log(samples)).
StraightEnds straight_ends(std::span<const Vec2> positions_m);

}  // namespace palpate
