#include "core/recognition/counted/way_set_aside.h"

#include <cmath>
#include <iterator>

namespace palpate {
namespace {

/// Of spikes at the end of a stroke, three lie on one side, each farther off than the one before,
/// one time in 2^2 3! = 24; four lie on one side one time in 2^3.
constexpr int kFewestInOrder = 3;
constexpr int kFewestOnOneSide = 4;

/// Deviations by which noise may bring a sample nearer to the curve than the one before.
constexpr double kNoise = 3.0;

/// `sample`, `is_aside`: from an end of a stroke inwards.
template <typename Sample, typename Flag>
bool leads_away(Sample sample, const Sample end, Flag is_aside, double tip_radius_m,
                const ExplainingCurve& curve) {
  bool in_order = true;
  double outer = 0.0;
  for (int count = 1; sample != end && *is_aside; ++sample, ++is_aside, ++count) {
    const double off = signed_distance_m(curve, *sample, tip_radius_m);
    if (count > 1) {
      if (off * outer < 0.0) {
        return false;
      }
      in_order = in_order && std::abs(off) <= std::abs(outer) + kNoise * noise_m(curve, *sample);
    }
    if (count >= kFewestOnOneSide || (count >= kFewestInOrder && in_order)) {
      return true;
    }
    outer = off;
  }
  return false;
}

}  // namespace

bool has_way_set_aside(std::span<const StoredPatch> patches, const std::vector<bool>& aside,
                       const ExplainingCurve& curve) {
  auto begin = aside.begin();
  for (const StoredPatch& patch : patches) {
    const std::vector<StoredSample>& samples = patch.samples;
    const auto end = begin + std::ssize(samples);
    const double tip_radius_m = patch.context.tip_radius_m;
    if (leads_away(samples.begin(), samples.end(), begin, tip_radius_m, curve) ||
        leads_away(samples.rbegin(), samples.rend(), std::reverse_iterator(end), tip_radius_m,
                   curve)) {
      return true;
    }
    begin = end;
  }
  return false;
}

}  // namespace palpate
