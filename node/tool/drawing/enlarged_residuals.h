// Residuals as lines from the curve, enlarged so that they can be seen.
#pragma once

#include <cstddef>
#include <vector>

#include "node/tool/drawing/drawing.h"

namespace palpate {

struct EnlargedResiduals {
  struct Line {
    Vec2 foot;
    Vec2 end;
  };
  double gain = 1.0;  ///< enlargement: 1, 2 or 5 times a power of ten
  std::vector<Line> lines;
  std::vector<Vec2> far;  ///< samples beyond kFarSigmas; they have no line
};

/// Draws every sample, or every second, third, ... if there are more than `most_lines` (far
/// samples: more than ten times that). `sigma_m`: noise of samples that state none. `size_m`: size
/// of the picture.
EnlargedResiduals enlarged_residuals(const CurveModel& model, const ContactGroup& group,
                                     double sigma_m, double size_m, std::size_t most_lines);

/// The largest value of the form 1, 2 or 5 times a power of ten that is at most `value` (> 0).
double round_gain(double value);

}  // namespace palpate
