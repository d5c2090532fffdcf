#include "core/local/reading_step.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

constexpr double kShare = 0.9;  // of all coordinates; the others may be means

/// Whether a coordinate, counted from another, is a multiple of the step, but for the rounding of
/// all, which single precision may have held.
bool is_multiple(double coordinate_m, double from_m, double step_m) {
  constexpr double kOfStep = 1e-6;  // a decimal number's step in double precision, many times over
  constexpr double kOfSingle = 0.5 * std::numeric_limits<float>::epsilon();
  // Of the step: nine tenths of n coordinates that are no multiples come as near once in 50^n.
  constexpr double kMostOfStep = 1e-2;
  const double steps = (coordinate_m - from_m) / step_m;
  const double rounding = kOfSingle * (std::abs(coordinate_m) + std::abs(from_m)) / step_m;
  return std::abs(steps - std::round(steps)) <= kOfStep + std::min(rounding, kMostOfStep);
}

bool are_multiples(std::span<const Vec2> samples, const Vec2& from, double step_m) {
  const double coordinates = 2.0 * static_cast<double>(samples.size());
  double others = 0.0;
  for (const Vec2& sample : samples) {
    others += is_multiple(sample.x(), from.x(), step_m) ? 0.0 : 1.0;
    others += is_multiple(sample.y(), from.y(), step_m) ? 0.0 : 1.0;
    if (others > (1.0 - kShare) * coordinates) {
      return false;
    }
  }
  return true;
}

}  // namespace

double reading_step_m(std::span<const Vec2> samples, double least_noise_m) {
  constexpr double kMostOfExtent = 0.01;  // coarser ones are shapes of a few digits
  constexpr double kLeast_m = 1e-9;       // no probe tells less
  constexpr std::array kDigits = {5.0, 2.54, 2.5, 2.0, 1.25, 1.0};
  Eigen::AlignedBox2d box;
  for (const Vec2& sample : samples) {
    box.extend(sample);
  }
  if (samples.empty() || !(box.sizes().maxCoeff() > 0.0)) {
    return 0.0;
  }
  const double largest_m = kMostOfExtent * box.sizes().maxCoeff();
  for (double power_m = std::pow(10.0, std::floor(std::log10(largest_m)));
       power_m >= 0.5 * kLeast_m; power_m /= 10.0) {
    if (noise_of_rounding_m(kDigits.front() * power_m) < least_noise_m) {
      return 0.0;
    }
    for (const double digit : kDigits) {
      const double step_m = digit * power_m;
      // From the first sample, for a tool's offset may have come after the rounding; that sample
      // may be a mean.
      if (step_m <= largest_m && (are_multiples(samples, samples.front(), step_m) ||
                                  are_multiples(samples, Vec2::Zero(), step_m))) {
        return step_m;
      }
    }
  }
  return 0.0;
}

}  // namespace palpate
