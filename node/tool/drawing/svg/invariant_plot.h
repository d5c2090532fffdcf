// Draws the recognition tree's invariants as in the paper: the estimate of each contact, and the
// value of all contacts together with its band.
#pragma once

#include <string>

#include "core/recognition/recognition.h"

namespace palpate {

/// An SVG document with one panel for each invariant of every class that the tree tested. `title`:
/// name of the data.
std::string invariant_plot(const Recognition& answer, const std::string& title);

}  // namespace palpate
