// Qualifies a probe on a ring and measures an elliptic part with it, with and without the
// qualification.
#pragma once

#include <ostream>

#include "tests/bench/real/ellipse_part.h"

namespace palpate::bench {

struct Ring {
  Recording recording;  ///< contacts on a circle
  double radius_m = 0.0;
};

/// Prints the probe's terms, the axes from the full turn, and arcs of 60 to 180 degrees, in
/// markdown; and how many answers to so many `simulations` of the recording are wrong (0 or 1: none
/// are made).
void print_qualified_part(const Ring& ring, const EllipsePart& part, int simulations,
                          std::ostream& out);

}  // namespace palpate::bench
