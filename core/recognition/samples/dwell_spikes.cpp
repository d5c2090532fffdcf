#include "core/recognition/samples/dwell_spikes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/numerics/quantile.h"

namespace palpate {
namespace {

/// Fewer readings do not tell what scatter is theirs.
constexpr std::size_t kFewest = 8;

/// The noise of a sample beside that of the others: as stated, or the same for all where any states
/// none.
double noise_beside_others(const StoredSample& sample, double default_sigma_m, bool is_stated) {
  return is_stated ? sigma_m_of(sample, default_sigma_m) / std::sqrt(sample.weight) : 1.0;
}

/// How far the readings of a place lie from their median place, by their noise.
std::vector<double> distances_of(std::span<const StoredSample> readings, double default_sigma_m) {
  std::vector<double> x;
  std::vector<double> y;
  for (const StoredSample& reading : readings) {
    x.push_back(reading.position_m.x());
    y.push_back(reading.position_m.y());
  }
  const Vec2 place(median_of(x), median_of(y));
  const bool is_stated = stated_variance_m2(readings, default_sigma_m).has_value();
  std::vector<double> distances;
  for (const StoredSample& reading : readings) {
    distances.push_back((reading.position_m - place).norm() /
                        noise_beside_others(reading, default_sigma_m, is_stated));
  }
  return distances;
}

/// Which readings lie farther from their median place than noise of the scatter that most of them
/// have, which a jitter along the part may be more of than is stated.
std::vector<bool> spikes_among(std::span<const StoredSample> readings, double default_sigma_m,
                               double false_alarm) {
  // A distance in the plane exceeds r deviations with the probability exp(-r^2 / 2): the median is
  // at kMedian. It is known to 0.72 / sqrt(n) of itself.
  constexpr double kMedian = 1.1774100225154747;
  constexpr double kKnownTo = 0.72;
  constexpr double kDeviations = 3.0;
  const auto n = static_cast<double>(readings.size());
  const std::vector<double> distances = distances_of(readings, default_sigma_m);
  std::vector<double> sorted = distances;
  const double deviation =
      median_of(sorted) / kMedian * (1.0 + kDeviations * kKnownTo / std::sqrt(n));
  const double farthest = deviation * std::sqrt(2.0 * std::log(n / false_alarm));
  std::vector<bool> is_spike;
  for (const double distance : distances) is_spike.push_back(distance > farthest);
  return is_spike;
}

}  // namespace

void set_spikes_apart(double default_sigma_m, double false_alarm, StoredPatch* patch,
                      std::vector<PatchSpan>* dwells) {
  for (PatchSpan& dwell : *dwells) {
    if (dwell.size() < kFewest) continue;
    const std::span<StoredSample> readings =
        std::span(patch->samples).subspan(dwell.begin, dwell.size());
    const std::vector<bool> is_spike = spikes_among(readings, default_sigma_m, false_alarm);
    const auto spikes =
        static_cast<std::size_t>(std::count(is_spike.begin(), is_spike.end(), true));
    // Where most lie far off, there is no place.
    if (spikes == 0 || 2 * spikes > readings.size()) continue;
    const bool ends_patch = dwell.end == patch->samples.size();
    const StoredPatch before = *patch;
    std::size_t spike = ends_patch ? dwell.begin : dwell.end - spikes;
    std::size_t good = ends_patch ? dwell.begin + spikes : dwell.begin;
    for (std::size_t i = 0; i < is_spike.size(); ++i) {
      const std::size_t to = is_spike[i] ? spike++ : good++;
      patch->samples[to] = before.samples[dwell.begin + i];
      patch->samples[to].is_off_dwell = is_spike[i];
      if (!patch->details.empty()) patch->details[to] = before.details[dwell.begin + i];
    }
    dwell = ends_patch ? PatchSpan{dwell.begin + spikes, dwell.end}
                       : PatchSpan{dwell.begin, dwell.end - spikes};
  }
}

}  // namespace palpate
