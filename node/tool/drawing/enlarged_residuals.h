// Residuals as lines from the curve, enlarged so that they can be seen.
#pragma once

#include <cstddef>
#include <span>
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
  std::vector<Vec2> far;        ///< samples beyond kFarSigmas that count; they have no line
  std::vector<Vec2> set_aside;  ///< samples that do not count
};

/// Draws every sample, or every second, third, ... if there are more than `most_lines` (far
/// samples: more than ten times that). `sigma_m`: noise of samples that state none. `size_m`: size
/// of the picture. `set_aside`: positions of spikes, right to a few times the noise.
EnlargedResiduals enlarged_residuals(const CurveModel& model, const ContactGroup& group,
                                     double sigma_m, double size_m, std::size_t most_lines,
                                     std::span<const Vec2> set_aside = {});

/// The largest value of the form 1, 2 or 5 times a power of ten that is at most `value` (> 0).
double round_gain(double value);

}  // namespace palpate
