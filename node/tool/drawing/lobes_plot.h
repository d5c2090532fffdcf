// The lobes of a qualified probe: offset by direction with its band, and the samples.
#pragma once

#include <string>

#include "core/qualification/qualify.h"

namespace palpate {

/// An SVG document: a polar picture of the offset, enlarged, and the residuals over the normal's
/// direction. At most 4,000 samples of each are drawn, evenly taken, and the picture says so.
std::string lobes_plot(const Qualification& qualification, const std::string& title);

}  // namespace palpate
