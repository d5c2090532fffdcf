// Residuals drawn as lines from the curve, so much enlarged that they can be seen.
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
  double gain = 1.0;  ///< 1, 2 or 5 times a power of ten
  std::vector<Line> lines;
  std::vector<Vec2> far;  ///< samples beyond kFarSigmas; they have no line
};

/// Of all samples, or of every second, third, ... where they are more than `most_lines` (the far
/// ones: more than ten times that). `sigma_m` is the noise of samples that bring none, `size_m` the
/// picture's.
EnlargedResiduals enlarged_residuals(const CurveModel& model, const ContactGroup& group,
                                     double sigma_m, double size_m, std::size_t most_lines);

/// 1, 2 or 5 times a power of ten: the largest that is at most `value` (> 0).
double round_gain(double value);

}  // namespace palpate
