// What the person who strokes the part should do next.
#pragma once

#include <string>

#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// What has been stated of the samples, as far as it is known here: no advice asks for it again.
struct Stated {
  bool noise = false;             ///< of every sample
  bool touched_from = false;      ///< outside or inside
  bool tip_sides = false;         ///< of every sample, or none is of a round tip
  double form_deviation_m = 0.0;  ///< 0 = not stated
};

/// One or two sentences: the answer, or why there is none yet, and what would help.
std::string advice_text(const v1::Recognition& answer, const Stated& stated = {});

}  // namespace palpate
