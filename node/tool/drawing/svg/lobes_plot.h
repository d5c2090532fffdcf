// Draws the lobes of a qualified probe: the offset by direction, less its mean, with its band, and
// the samples.
#pragma once

#include <string>

#include "core/qualification/qualify.h"

namespace palpate {

/// An SVG document: a polar picture of the enlarged lobes with a scale, and the residuals over the
/// direction of the normal. It shows at most 4,000 samples in each, evenly selected, and says so.
std::string lobes_plot(const Qualification& qualification, const std::string& title);

}  // namespace palpate
