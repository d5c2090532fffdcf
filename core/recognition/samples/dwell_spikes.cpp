#include "core/recognition/samples/dwell_spikes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/numerics/probability/normal_law.h"
#include "core/numerics/quantile.h"
#include "core/recognition/samples/sample_block.h"

namespace palpate {
namespace {

/// How far the readings of a place lie from their median place: in deviations of their noise, if
/// that `is_stated`.
std::vector<double> distances_of(std::span<const StoredSample> readings, double default_sigma_m,
                                 bool is_stated) {
  const Vec2 place = median_place(readings);
  std::vector<double> distances;
  distances.reserve(readings.size());
  for (const StoredSample& reading : readings) {
    const double unit =
        is_stated ? sigma_m_of(reading, default_sigma_m) / std::sqrt(reading.weight) : 1.0;
    distances.push_back((reading.position_m - place).norm() / unit);
  }
  return distances;
}

/// Which readings lie farther from their median place than the scatter that most of them have lets
/// them, which a jitter along the part may be more of than is stated, or the stated noise.
std::vector<bool> spikes_among(std::span<const StoredSample> readings, double default_sigma_m,
                               double false_alarm) {
  // A distance in the plane exceeds r deviations with the probability exp(-r^2 / 2): the median is
  // at kMedianInPlane. It is known to 0.72 / sqrt(n) of itself.
  constexpr double kKnownTo = 0.72;
  constexpr double kDeviations = 3.0;
  const auto n = static_cast<double>(readings.size());
  const bool is_stated = stated_variance_m2(readings, default_sigma_m).has_value();
  const std::vector<double> distances = distances_of(readings, default_sigma_m, is_stated);
  std::vector<double> sorted = distances;
  const double deviation =
      std::max(median_of(sorted) / kMedianInPlane * (1.0 + kDeviations * kKnownTo / std::sqrt(n)),
               is_stated ? 1.0 : 0.0);
  // Most readings of a coarse scale may be one number: then they show no scatter.
  const double farthest = deviation > 0.0 ? deviation * std::sqrt(2.0 * std::log(n / false_alarm))
                                          : std::numeric_limits<double>::infinity();
  std::vector<bool> is_spike;
  is_spike.reserve(distances.size());
  for (const double distance : distances) is_spike.push_back(distance > farthest);
  return is_spike;
}

}  // namespace

void set_spikes_apart(double default_sigma_m, double false_alarm, StoredPatch* patch,
                      std::vector<PatchSpan>* dwells) {
  constexpr std::size_t kFewestReadings = 8;  // fewer do not tell what scatter is theirs
  for (PatchSpan& dwell : *dwells) {
    if (dwell.size() < kFewestReadings) continue;
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
