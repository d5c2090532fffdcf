// The step to which a probe, or the file that it wrote, has rounded its readings.
#pragma once

#include <span>

#include "core/curves/pose2.h"

namespace palpate {

/// The largest of 1, 1.25, 2, 2.5, 2.54 and 5 times a power of ten, from 1 nm up, of which nine
/// tenths of the coordinates are multiples, from 0 or the first sample's: means of samples need not
/// be. 0 if there is none. No more than a hundredth of the samples' extent: coarser ones are shapes
/// of a few digits. Steps whose noise is below `least_noise_m` are not looked for. [m] O(samples).
double reading_step_m(std::span<const Vec2> samples, double least_noise_m = 0.0);

/// Standard deviation of an error that is equally probable anywhere within such a step.
inline double noise_of_rounding_m(double step_m) {
  constexpr double kRootOf12 = 3.4641016151377544;
  return step_m / kRootOf12;
}

}  // namespace palpate
