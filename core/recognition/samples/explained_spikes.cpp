#include "core/recognition/samples/explained_spikes.h"

#include <cassert>
#include <cmath>

namespace palpate {

std::optional<std::vector<StoredPatch>> with_explained_spikes(std::span<const StoredPatch> all,
                                                              std::span<const StoredPatch> clean,
                                                              const Curve& curve,
                                                              const Pose2& world_T_curve,
                                                              double noise_m, double limit) {
  assert(all.size() == clean.size());
  std::vector<StoredPatch> result(clean.begin(), clean.end());
  bool any = false;
  for (std::size_t p = 0; p < all.size(); ++p) {
    const std::vector<StoredSample>& kept = clean[p].samples;
    if (kept.size() == all[p].samples.size()) {
      continue;
    }
    std::vector<StoredSample>& samples = result[p].samples;
    samples.clear();
    std::size_t next = 0;
    for (const StoredSample& sample : all[p].samples) {
      if (next < kept.size() && kept[next].position_m == sample.position_m) {
        samples.push_back(sample);
        ++next;
        continue;
      }
      const FootPoint foot = foot_point(curve, world_T_curve.to_local(sample.position_m));
      const double sigma =
          (sample.sigma_m > 0.0 ? sample.sigma_m : noise_m) / std::sqrt(sample.weight);
      if (std::abs(std::abs(foot.distance) - all[p].context.tip_radius_m) <= limit * sigma) {
        samples.push_back(sample);
        any = true;
      }
    }
  }
  return any ? std::optional(std::move(result)) : std::nullopt;
}

}  // namespace palpate
