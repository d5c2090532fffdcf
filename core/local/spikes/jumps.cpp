#include "core/local/spikes/jumps.h"

#include <algorithm>

#include "core/numerics/quantile.h"

namespace palpate {
namespace {

/// How long each step is. [m]
std::vector<double> steps_of(std::span<const Vec2> samples) {
  std::vector<double> steps;
  steps.reserve(samples.size());
  for (std::size_t i = 1; i < samples.size(); ++i) {
    steps.push_back((samples[i] - samples[i - 1]).norm());
  }
  return steps;
}

/// Longer than this, a step is a jump. [m]
double long_step_m(std::vector<double> steps) {
  constexpr double kShort = 0.2;  // of all steps; with a third of spikes, (2/3)^2 have none
  // Times a short step: a stroke that slows down to a quarter of its speed has no longer ones.
  constexpr double kJump = 4.0;
  return kJump * quantile_of(steps, kShort);
}

}  // namespace

std::vector<std::uint8_t> jumps_of(std::span<const Vec2> samples) {
  std::vector<std::uint8_t> jumps(samples.size());
  if (samples.size() < 3) {
    return jumps;
  }
  const std::vector<double> steps = steps_of(samples);
  const double long_m = long_step_m(steps);
  for (std::size_t i = 1; i < steps.size(); ++i) {
    jumps[i] = std::min(steps[i - 1], steps[i]) > long_m ? 1 : 0;
  }
  return jumps;
}

std::vector<std::uint8_t> detours_of(std::span<const Vec2> samples) {
  std::vector<std::uint8_t> is_off(samples.size());
  if (samples.size() < 3) {
    return is_off;
  }
  const std::vector<double> steps = steps_of(samples);
  const double long_m = long_step_m(steps);
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    if (!(steps[i] > long_m)) {
      continue;
    }
    const std::size_t most = std::min(kLongestRunOfSpikes, steps.size() - i - 1);
    for (std::size_t run = 1; run <= most; ++run) {
      const double on = (samples[i + run + 1] - samples[i]).norm();
      if (std::min(steps[i], steps[i + run]) > std::max(long_m, on)) {
        std::fill_n(is_off.begin() + static_cast<std::ptrdiff_t>(i) + 1, run, 1);
      }
    }
  }
  return is_off;
}

}  // namespace palpate
