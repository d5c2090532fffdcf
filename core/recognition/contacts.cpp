#include "core/recognition/contacts.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/curves/curve.h"
#include "core/local/noise.h"
#include "core/local/stream/window_fit.h"
#include "core/local/tip_radius.h"
#include "core/recognition/samples/mean_on_path.h"

namespace palpate {
namespace {

/// Factor by which a window that is too long is shortened: as in the stream (sliding_window.h).
constexpr double kShrink = 0.9;

/// The samples of a patch with their weights, and the noise of a sample of weight 1.
struct WeightedPath {
  std::vector<PathNode> nodes;
  std::optional<double> noise;  ///< nullopt = unknown
  bool stated = true;           ///< by the samples or as a default, not estimated
  double sigma_m = 0.0;         ///< of a typical contact
};

WeightedPath weighted_path(const StoredPatch& patch, double default_sigma_m) {
  WeightedPath path;
  path.nodes.reserve(patch.samples.size());
  double variances = 0.0;
  for (std::size_t i = 0; i < patch.samples.size(); ++i) {
    const StoredSample& sample = patch.samples[i];
    const double sigma = sigma_m_of(sample, default_sigma_m);
    path.stated = path.stated && sigma > 0.0;
    variances += sigma * sigma;
    path.nodes.push_back({mean_on_path(patch, i), sample.weight / (sigma * sigma)});
  }
  if (path.stated) {
    path.noise = 1.0;
    path.sigma_m = std::sqrt(variances / static_cast<double>(patch.samples.size()));
    return path;
  }
  std::vector<Vec2> positions;
  positions.reserve(path.nodes.size());
  double weights = 0.0;
  for (std::size_t i = 0; i < path.nodes.size(); ++i) {
    path.nodes[i].weight = patch.samples[i].weight;
    weights += path.nodes[i].weight;
    positions.push_back(path.nodes[i].position_m);
  }
  // Noise of the stored samples, each a mean of several contacts.
  const NoiseEstimate noise = estimate_noise(positions);
  if (noise.status == LocalStatus::Ok) {
    path.noise = noise.sigma_m * std::sqrt(weights / static_cast<double>(positions.size()));
    path.sigma_m = *path.noise;
  }
  return path;
}

/// Reduces a window of any length to the nodes that the fit takes.
std::vector<PathNode> reduced(std::span<const PathNode> window) {
  const std::size_t block =
      (window.size() + NodePyramid::kBlocksPerWindow - 1) / NodePyramid::kBlocksPerWindow;
  if (block < 2) {
    return {window.begin(), window.end()};
  }
  std::vector<PathNode> nodes;
  for (std::size_t first = 0; first < window.size(); first += block) {
    const std::span<const PathNode> samples =
        window.subspan(first, std::min(block, window.size() - first));
    if (samples.size() == 1) {
      nodes.push_back(samples.front());
      continue;
    }
    for (const PathNode& node : two_nodes(samples)) {
      nodes.push_back(node);
    }
  }
  return nodes;
}

/// Keeps at most kMostContactsOfAPatch; of equally informative ones, the first.
void keep_most_informative(std::vector<LocalizedContact>* found) {
  if (found->size() <= kMostContactsOfAPatch) {
    return;
  }
  std::vector<std::pair<double, std::size_t>> order;
  order.reserve(found->size());
  for (const LocalizedContact& contact : *found) {
    order.emplace_back(uncertainty(contact), order.size());
  }
  const auto end = order.begin() + kMostContactsOfAPatch;
  std::nth_element(order.begin(), end, order.end());
  std::vector<bool> kept(found->size(), false);
  for (auto chosen = order.begin(); chosen != end; ++chosen) {
    kept[chosen->second] = true;
  }
  std::size_t i = 0;
  std::erase_if(*found, [&](const LocalizedContact&) { return !kept[i++]; });
}

/// Windows side by side, as many as fit, in the middle of the patch.
std::vector<LocalizedContact> fixed_windows(const StoredPatch& patch, EstimatorOptions estimator,
                                            double default_sigma_m, double signed_radius) {
  estimator.sigma_m = std::sqrt(stated_variance_m2(patch.samples, default_sigma_m).value_or(0.0));
  std::vector<Vec2> positions;
  positions.reserve(patch.samples.size());
  for (std::size_t i = 0; i < patch.samples.size(); ++i) {
    positions.push_back(mean_on_path(patch, i));
  }
  const std::size_t window = samples_per_estimate(estimator);
  std::vector<LocalizedContact> found;
  for (std::size_t first = positions.size() % window / 2; first + window <= positions.size();
       first += window) {
    const LocalResult result =
        estimate_window(std::span(positions).subspan(first, window), estimator);
    const auto surface = result ? surface_from_tip(result.estimate, signed_radius) : std::nullopt;
    if (surface) {
      found.push_back({patch.context.probe, patch.context.patch, 0.0, *surface});
    }
  }
  return found;
}

}  // namespace

double uncertainty(const LocalizedContact& contact) {
  return contact.estimate.covariance.bottomRightCorner<3, 3>().determinant();
}

std::size_t windows_of_a_patch(std::size_t patches, const ContactOptions& options) {
  const std::size_t count = std::max<std::size_t>(patches, 1);
  return std::max(options.windows_per_patch, (options.least_windows + count - 1) / count);
}

void add_contacts(const StoredPatch& patch, std::size_t least_windows, int side,
                  const ContactOptions& options, std::vector<LocalizedContact>* contacts) {
  const double signed_radius = side * patch.context.tip_radius_m;
  if (options.estimator) {
    std::vector<LocalizedContact> found =
        fixed_windows(patch, *options.estimator, options.sigma_m, signed_radius);
    keep_most_informative(&found);
    contacts->insert(contacts->end(), found.begin(), found.end());
    return;
  }
  const WeightedPath path = weighted_path(patch, options.sigma_m);
  const std::size_t n = path.nodes.size();
  if (!path.noise) {
    return;
  }
  const double noise = *path.noise * std::sqrt(options.noise_time);
  const std::size_t fewest = std::max(options.window_samples, kFewestWindowNodes);
  const std::size_t windows = std::clamp<std::size_t>(n / fewest, 1, least_windows);
  const std::size_t longest = n / windows;
  // Over the window before: a path that could not be followed for long rarely can be at once. So
  // the windows tried are in all a bounded number of times the path.
  constexpr std::size_t kGrowth = 2;
  std::size_t most = longest;
  std::vector<LocalizedContact> found;
  for (std::size_t first = 0; first + std::min(longest, fewest) <= n && longest > 0;) {
    std::size_t length = std::min(most, n - first);
    LocalResult fit;
    for (bool shortest = false; !fit && !shortest;) {
      const auto shorter = static_cast<std::size_t>(kShrink * static_cast<double>(length));
      shortest = shorter < fewest;
      fit = fit_window(reduced(std::span(path.nodes).subspan(first, length)), noise,
                       options.form_deviation_m, shortest && !path.stated);
      if (!fit && !shortest) {
        length = shorter;
      }
    }
    first += length;
    most = std::min(kGrowth * length, longest);
    if (!fit) {
      continue;
    }
    fit.estimate.window_samples = static_cast<int>(length);
    fit.estimate.sigma_m = path.sigma_m;
    if (const auto surface = surface_from_tip(fit.estimate, signed_radius)) {
      found.push_back({patch.context.probe, patch.context.patch, 0.0, *surface});
    }
  }
  keep_most_informative(&found);
  contacts->insert(contacts->end(), found.begin(), found.end());
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
