#include "core/recognition/contacts.h"

#include <algorithm>
#include <cmath>

#include "core/curves/curve.h"
#include "core/local/adaptive_jet.h"
#include "core/local/jet_estimator.h"
#include "core/local/tip_radius.h"

namespace palpate {
namespace {

LocalResult estimate(std::span<const Vec2> window, PatchPlace place, double sigma_m,
                     bool with_bias) {
  if (with_bias) {
    return adaptive_jet(window, place, sigma_m).result;
  }
  JetOptions jet;
  jet.sigma_m = sigma_m;
  jet.place = place == PatchPlace::Start ? -1.0 : place == PatchPlace::End ? 1.0 : 0.0;
  return jet_estimate(window, jet);
}

}  // namespace

std::vector<LocalizedContact> estimate_contacts(std::span<const StoredPatch> patches,
                                                std::span<const int> sides,
                                                const ContactOptions& options) {
  std::vector<LocalizedContact> contacts;
  std::vector<Vec2> points;
  const std::size_t patch_count = std::max<std::size_t>(patches.size(), 1);
  const std::size_t wanted = std::max(options.windows_per_patch,
                                      (options.least_windows + patch_count - 1) / patch_count);
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const StoredPatch& patch = patches[p];
    points.clear();
    double variance = 0.0;
    bool known = true;
    for (const StoredSample& sample : patch.samples) {
      points.push_back(sample.position_m);
      const double sigma = sample.sigma_m > 0.0 ? sample.sigma_m : options.sigma_m;
      known = known && sigma > 0.0;
      variance += sigma * sigma / sample.weight;
    }
    const std::size_t n = points.size();
    const std::size_t windows = std::clamp<std::size_t>(n / options.window_samples, 1, wanted);
    const double signed_radius =
        p < sides.size() ? sides[p] * patch.context.tip_radius_m : 0.0;
    const auto add = [&](std::size_t window, PatchPlace place) {
      const std::size_t begin = window * n / windows;
      const std::size_t end = (window + 1) * n / windows;
      const double sigma = known && n > 0 ? std::sqrt(variance / static_cast<double>(n)) : 0.0;
      const LocalResult result = estimate(std::span(points).subspan(begin, end - begin), place,
                                          sigma, options.with_bias);
      if (!result) {
        return;
      }
      if (const auto surface = surface_from_tip(result.estimate, signed_radius)) {
        contacts.push_back({patch.context.probe, patch.context.patch, 0.0, *surface});
      }
    };
    add(0, PatchPlace::Start);
    for (std::size_t window = 0; window < windows; ++window) {
      add(window, PatchPlace::Centre);
    }
    add(windows - 1, PatchPlace::End);
  }
  return contacts;
}

void localise_contacts(const ShapeParameters& shape, const Pose2& world_T_curve,
                       std::vector<LocalizedContact>* contacts) {
  const auto curve = make_curve(shape.curve_class, shape.values);
  if (!curve) {
    return;
  }
  for (LocalizedContact& contact : *contacts) {
    contact.t = foot_point(*curve, world_T_curve.to_local(contact.estimate.position)).t;
  }
}

}  // namespace palpate
