// The whole answer in words where its noise may be estimated.
#pragma once

#include <string>

#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// As report_text of recognition_text.h. Chi-square is left out where the noise is not known: taken
/// in units of noise that was estimated from the same samples, it tells nothing.
std::string report_text(const v1::Recognition& answer, bool noise_is_known);

}  // namespace palpate
