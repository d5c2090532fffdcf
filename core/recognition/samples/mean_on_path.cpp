#include "core/recognition/samples/mean_on_path.h"

#include <algorithm>
#include <array>

namespace palpate {
namespace {

/// Second derivative by the index, of the least-squares parabola through this many samples: sum w_j
/// (j^2 - 4) / 42. Its noise moves a place by a hundredth of the sample's own.
constexpr std::size_t kSamples = 7;
constexpr std::array<double, kSamples> kWeights = {5.0, 0.0, -3.0, -4.0, -3.0, 0.0, 5.0};
constexpr double kDivisor = 42.0;

}  // namespace

Vec2 mean_on_path(const StoredPatch& patch, std::size_t i) {
  const StoredSample& sample = patch.samples[i];
  const double per_sample = patch.contacts_per_sample;
  // The newest may not be full yet, and lies closer to the next: the last one, or the first of a
  // pass that came back.
  const std::size_t first = patch.samples.front().contacts < per_sample ? 1 : 0;
  const std::size_t end =
      patch.samples.size() - (patch.samples.back().contacts < per_sample ? 1 : 0);
  if (sample.contacts <= 1.0 || sample.contacts > per_sample || end < first + kSamples) {
    return sample.position_m;
  }
  const std::size_t begin = std::clamp(i - std::min(i, kSamples / 2), first, end - kSamples);
  Vec2 second = Vec2::Zero();
  for (std::size_t j = 0; j < kSamples; ++j) {
    // From the sample's own place: far from the origin, coordinates have few digits for the rest.
    second += kWeights[j] * (patch.samples[begin + j].position_m - sample.position_m);
  }
  second /= kDivisor;
  // By the index, n contacts at steps of 1 / per_sample have a variance of (n^2 - 1) / (12
  // per_sample^2), and the mean of a path is off by half of that times its second derivative,
  // whatever the speed: what is along the path moves nothing.
  const double variance =
      (sample.contacts * sample.contacts - 1.0) / (12.0 * per_sample * per_sample);
  return sample.position_m - 0.5 * variance * second;
}

}  // namespace palpate
