// Arcs of a closed elliptic part of known size: errors, how often the answer is certain, and how
// often it is wrong.
#pragma once

#include <filesystem>
#include <optional>
#include <ostream>

#include "tests/bench/real/recording.h"

namespace palpate::bench {

struct EllipsePart {
  Recording recording;  ///< contacts all around the part, in order
  double semi_major_m = 0.0;
  double semi_minor_m = 0.0;
  /// State that the material is inside; otherwise both sides of the tip's centres are possible.
  bool side_known = false;
  /// Form error of the part (RecognizerOptions::form_deviation_m).
  double form_deviation_m = 0.0;
};

/// Prints a table in markdown, without a stated form deviation and with the part's. With `arcs_csv`
/// it also writes the points of each arc for opencv_arcs.py. Throws std::runtime_error if the whole
/// recording gives no ellipse, or if the file cannot be written.
void print_ellipse_part(const EllipsePart& part,
                        const std::optional<std::filesystem::path>& arcs_csv, std::ostream& out);

}  // namespace palpate::bench
