#include "tests/support/scene_prior.h"

#include <cmath>
#include <utility>

#include "tests/support/test_rng.h"

namespace palpate::test {
namespace {

constexpr double kLeastSize_m = 5e-3;
constexpr double kMostSize_m = 0.5;
constexpr int kMostPatches = 4;

Scene touched(CurveClass curve_class, OutsideShape shape, const SceneOptions& options,
              std::mt19937_64& rng) {
  return curve_class == CurveClass::Unclassified ? random_outside_scene(shape, options, rng)
                                                 : random_scene(curve_class, options, rng);
}

}  // namespace

ScenePrior even_prior() { return {}; }

ScenePrior classes_only(ScenePrior prior) {
  prior.frequency[static_cast<std::size_t>(CurveClass::Unclassified)] = 0.0;
  return prior;
}

ScenePrior other_prior() {
  ScenePrior prior;
  prior.frequency[static_cast<std::size_t>(CurveClass::CubicSpline)] *= 5.0;
  prior.least_arc_over_size *= 0.5;
  prior.most_arc_over_size *= 0.5;
  return prior;
}

PriorScene scene_from(const ScenePrior& prior, std::uint64_t seed, std::uint32_t number) {
  std::mt19937_64 rng = seeded_rng(seed, {number});
  std::discrete_distribution<int> kinds(prior.frequency.begin(), prior.frequency.end());
  const auto curve_class = static_cast<CurveClass>(kinds(rng));
  const auto shape = static_cast<OutsideShape>(std::uniform_int_distribution<int>(0, 3)(rng));
  SceneOptions options;
  options.patches = std::uniform_int_distribution<int>(1, kMostPatches)(rng);
  options.sigma_over_size =
      log_uniform(rng, prior.least_sigma_over_size, prior.most_sigma_over_size);
  options.size_m = log_uniform(rng, kLeastSize_m, kMostSize_m);
  options.least_arc_over_size = prior.least_arc_over_size;
  options.most_arc_over_size = prior.most_arc_over_size;
  // Draw the same numbers with and without noise.
  std::mt19937_64 same = rng;
  PriorScene result;
  result.size_m = options.size_m;
  result.scene = touched(curve_class, shape, options, rng);
  options.sigma_over_size = 0.0;
  result.exact_patches = touched(curve_class, shape, options, same).patches;
  return result;
}

}  // namespace palpate::test
