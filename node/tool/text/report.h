// The whole answer as text, when its noise may be estimated.
#pragma once

#include <string>

#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// Like report_text of recognition_text.h, but without chi-square if the noise is not known:
/// relative to noise estimated from the same samples, chi-square says nothing.
std::string report_text(const v1::Recognition& answer, bool noise_is_known);

}  // namespace palpate
