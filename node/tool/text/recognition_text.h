// A recognition for a person to read.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// The sentence for a doubt, e.g. "several classes remain plausible".
std::string_view sentence_of(v1::RecognitionDoubt doubt);

/// "ellipse", "semi-cubical parabola".
std::string spoken_name(v1::CurveClass curve_class);

/// A shape parameter or a component of the pose.
struct Quantity {
  std::string name;    ///< "a", "b", "c", "x", "y", "theta"
  double value = 0.0;  ///< in SI units
  double sigma = 0.0;  ///< standard deviation; infinite where the data do not determine it
  std::string text;    ///< "30.0012 +- 0.0021 mm"
};

/// The answer's shape parameters, then its pose; empty where it names no curve.
std::vector<Quantity> quantities_of(const v1::Recognition& answer);

/// "recognized", "ambiguous: several classes remain plausible".
std::string status_text(const v1::Recognition& answer);

/// One line: class, parameters and pose with their standard deviations.
std::string summary_text(const v1::Recognition& answer);

/// The recognition tree's invariants by class, in powers of metres: "ellipse Ic1 163 +- 16,
/// Ic2 52.1
/// +- 3.2; parabola Ip 3.1 +- 0.2"; empty where it asked about no class.
std::string invariants_text(const v1::Recognition& answer);

/// The whole answer, several lines, each ended.
std::string report_text(const v1::Recognition& answer);

}  // namespace palpate
