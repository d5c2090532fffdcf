// A recognition for a person to read.
#pragma once

#include <string>

#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// The sentence for a doubt, e.g. "several classes remain plausible".
std::string_view sentence_of(v1::RecognitionDoubt doubt);

/// "ellipse", "semi-cubical parabola".
std::string spoken_name(v1::CurveClass curve_class);

/// One line: class, parameters and pose with their standard deviations.
std::string summary_text(const v1::Recognition& answer);

/// The whole answer, several lines, each ended.
std::string report_text(const v1::Recognition& answer);

}  // namespace palpate
