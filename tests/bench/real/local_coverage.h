// Checks the deviations of the sliding window along a closed elliptic part of known size: how often
// they contain the error.
#pragma once

#include <ostream>

#include "tests/bench/real/ellipse_part.h"

namespace palpate::bench {

/// Prints a table in markdown: kappa and kappa_s of every window of turns from places all around,
/// beside the part's at the place, laid on the contacts by its pose alone; without a stated form
/// deviation and with the part's. The material is said to lie inside. Throws std::runtime_error
/// where the part cannot be laid on the recording.
void print_local_coverage(const EllipsePart& part, std::ostream& out);

}  // namespace palpate::bench
