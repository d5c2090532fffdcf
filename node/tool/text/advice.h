// What the person who strokes the part should do next.
#pragma once

#include <string>

#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// One or two sentences: the answer, or why there is none yet, and what would help.
std::string advice_text(const v1::Recognition& answer);

}  // namespace palpate
