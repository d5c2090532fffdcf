#include "core/recognition/samples/work_limit.h"

#include <algorithm>

namespace palpate {
namespace {

/// Of kMostWork, for what is done of one weighing in any case, and of the one that has begun when
/// the rest is spent.
constexpr double kAlways = 1.2;

/// Touches one at a time, over strokes of as many samples: no neighbours tell a tip's direction,
/// the arms or the order, so that what is sought is sought for each again. What touches that are
/// recognised take (lone_touches_test) must be allowed.
constexpr double kOfTouches = 8.0;

/// Samples that state covariances, over those that do not: path, places and weights are found in
/// turn, and classes on all points. An ellipse takes so much in the middle of all sizes
/// (`bench_worst_case --ellipses`), and up to three times that.
constexpr double kOfCovariances = 2.5;

bool have_covariances(std::span<const StoredPatch> patches) {
  return std::ranges::any_of(patches, [](const StoredPatch& patch) {
    return std::ranges::any_of(
        patch.details, [](const SampleDetail& detail) { return detail.covariance_m2.x() > 0.0; });
  });
}

}  // namespace

// By `bench_worst_case --ellipses`, right to a quarter for most sizes: seldom more than they take.
double work_of_clean_ellipse(std::size_t samples, std::size_t patches) {
  const auto n = static_cast<double>(samples);
  const auto p = static_cast<double>(patches);
  // Every sample is read, smoothed, and stands in the best class's last steps.
  constexpr double kOfSample = 15.7;
  // The search goes through the points that stand for samples: through all samples where these are
  // few; a dozen of a patch; 64 of many patches, which are then followed on all.
  const double by_samples = 406.0 * n + 2050.0 * p - 1070.0;
  const double of_few_patches = 7550.0 + 3980.0 * p;
  const double of_some_patches = 13200.0 + 2160.0 * p;
  const double of_many_patches = 40700.0 + 440.0 * p;
  return kOfSample * n + std::min({by_samples, of_few_patches, of_some_patches, of_many_patches});
}

WorkBudget work_limit(std::span<const StoredPatch> patches, double patience) {
  const std::size_t samples = count_samples(patches);
  const double by_strokes = work_of_clean_ellipse(samples, patches.size());
  const double clean = by_strokes * (are_mostly_touches(patches) ? kOfTouches
                                     : have_covariances(patches) ? kOfCovariances
                                                                 : 1.0);
  WorkBudget work(patience * kMostWork * clean, kAlways * clean);
  work.spend(WorkKind::Sample, samples);
  return work;
}

}  // namespace palpate
