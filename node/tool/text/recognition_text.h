// A recognition as text for a person to read.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// Less probable hypotheses are not named in texts.
inline constexpr double kWorthNaming = 0.01;

/// Whether the answer is "unclassified" and names no class beside it.
bool is_of_no_class_alone(const v1::Recognition& answer);

/// The sentence for a doubt, e.g. "several classes remain plausible".
std::string_view sentence_of(v1::RecognitionDoubt doubt);

/// E.g. "ellipse", "semi-cubical parabola".
std::string spoken_name(v1::CurveClass curve_class);

/// A shape parameter or a component of the pose.
struct Quantity {
  std::string name;    ///< "a", "b", "c", "x", "y", "theta"
  double value = 0.0;  ///< in SI units
  double sigma = 0.0;  ///< standard deviation; infinite if the data do not determine the value
  std::string text;    ///< e.g. "30.0012 +- 0.0021 mm"
};

/// The shape parameters of the answer, then its pose. Empty if the answer names no curve.
std::vector<Quantity> quantities_of(const v1::Recognition& answer);

/// E.g. "recognized", "ambiguous: several classes remain plausible".
std::string status_text(const v1::Recognition& answer);

/// Standard deviation of the samples, e.g. "30 um", or "not known yet".
std::string noise_text(const v1::Recognition& answer);

/// One line: class, parameters and pose with their standard deviations.
std::string summary_text(const v1::Recognition& answer);

/// The recognition tree's invariants by class, in powers of metres, e.g. "ellipse Ic1 163 +- 16,
/// Ic2 52.1 +- 3.2; parabola Ip 3.1 +- 0.2". Empty if the tree tested no class.
std::string invariants_text(const v1::Recognition& answer);

/// The whole answer: several lines, each ending with a line feed.
std::string report_text(const v1::Recognition& answer);

}  // namespace palpate
