#include "core/recognition/contacts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/curves/curve.h"
#include "core/local/adaptive_jet.h"
#include "core/local/jet_estimator.h"
#include "core/local/tip_radius.h"

namespace palpate {
namespace {

constexpr std::size_t kMostPlaces = 3;  // of a window: its centre, and the patch's ends

/// Estimates at those places of one window.
void estimate(std::span<const Vec2> window, std::span<const PatchPlace> places, double sigma_m,
              bool with_bias, std::span<LocalResult> results) {
  if (with_bias) {
    std::transform(places.begin(), places.end(), results.begin(),
                   [&](PatchPlace place) { return adaptive_jet(window, place, sigma_m).result; });
    return;
  }
  JetOptions jet;
  jet.sigma_m = sigma_m;
  std::array<double, kMostPlaces> at{};
  std::transform(places.begin(), places.end(), at.begin(), [](PatchPlace place) {
    return place == PatchPlace::Start ? -1.0 : place == PatchPlace::End ? 1.0 : 0.0;
  });
  jet_estimates(window, jet, std::span(at).first(places.size()), results);
}

}  // namespace

std::size_t windows_of_a_patch(std::size_t patches, const ContactOptions& options) {
  const std::size_t count = std::max<std::size_t>(patches, 1);
  return std::max(options.windows_per_patch, (options.least_windows + count - 1) / count);
}

void add_contacts(const StoredPatch& patch, std::size_t most_windows, int side,
                  const ContactOptions& options, std::vector<LocalizedContact>* contacts) {
  std::vector<Vec2> points;
  points.reserve(patch.samples.size());
  double variance = 0.0;
  bool known = true;
  for (const StoredSample& sample : patch.samples) {
    points.push_back(sample.position_m);
    const double sigma = sample.sigma_m > 0.0 ? sample.sigma_m : options.sigma_m;
    known = known && sigma > 0.0;
    variance += sigma * sigma / sample.weight;
  }
  const std::size_t n = points.size();
  const std::size_t windows = std::clamp<std::size_t>(n / options.window_samples, 1, most_windows);
  const double signed_radius = side * patch.context.tip_radius_m;
  const double sigma = known && n > 0 ? std::sqrt(variance / static_cast<double>(n)) : 0.0;
  for (std::size_t window = 0; window < windows; ++window) {
    std::array<PatchPlace, kMostPlaces> places{};
    std::size_t count = 0;
    if (window == 0) {
      places[count++] = PatchPlace::Start;
    }
    places[count++] = PatchPlace::Centre;
    if (window + 1 == windows) {
      places[count++] = PatchPlace::End;
    }
    const std::size_t begin = window * n / windows;
    const std::size_t end = (window + 1) * n / windows;
    std::array<LocalResult, kMostPlaces> results;
    estimate(std::span(points).subspan(begin, end - begin), std::span(places).first(count), sigma,
             options.with_bias, std::span(results).first(count));
    for (const LocalResult& result : std::span(results).first(count)) {
      if (!result) {
        continue;
      }
      if (const auto surface = surface_from_tip(result.estimate, signed_radius)) {
        contacts->push_back({patch.context.probe, patch.context.patch, 0.0, *surface});
      }
    }
  }
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
