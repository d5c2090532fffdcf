// Checks the deviations of the sliding window along a closed elliptic part of known size: how often
// they contain the error.
#pragma once

#include <ostream>

#include "tests/bench/real/ellipse_part.h"

namespace palpate::bench {

/// Prints a table in markdown: kappa and kappa_s of every window, for turns from places all around,
/// compared with the part's at that place; the part's pose is fitted to the contacts. Without a
/// stated form deviation and with the part's. States that the material is inside. Throws
/// std::runtime_error if the part cannot be fitted to the recording.
void print_local_coverage(const EllipsePart& part, std::ostream& out);

}  // namespace palpate::bench
