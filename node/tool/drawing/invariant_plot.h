// The recognition tree's invariants drawn as in the paper: what each contact says, and the value
// with its band that all of them give.
#pragma once

#include <string>

#include "core/recognition/recognition.h"

namespace palpate {

/// An SVG document, a panel an invariant of every class that the tree asked about. `title` names
/// the data.
std::string invariant_plot(const Recognition& answer, const std::string& title);

}  // namespace palpate
