// Time of a full recognition, with all classes considered: bench_recognition
//   cold: a new recognizer for every scene. Over 64 random scenes of each class, two patches.
//   cold_told: the same scenes of an ellipse: with the noise stated; not stated, but said to be all
//     by which the probe errs; and told nothing.
//   warm: ten more samples for a recognizer that has answered before.
//   stream: whole scenes, ten samples at a time.
//   live_tree: invariants and tree of an answer. The label is the mean number of contacts.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <random>

#include "core/recognition/fit/class_fits.h"
#include "core/recognition/reported_tree_path.h"
#include "core/recognition/smooth/smooth_model.h"
#include "tests/support/answered_scene.h"
#include "tests/support/scene_data.h"

namespace palpate {
namespace {

constexpr int kScenes = 64;
constexpr int kBesideCusp = 8;  // more patches find no place each beside it

std::vector<test::Scene> scenes_of(CurveClass curve_class, int points_per_patch, int patches) {
  std::mt19937_64 rng(11);
  test::SceneOptions options;
  options.points_per_patch = points_per_patch;
  options.patches = patches;
  // Many patches share the curve piece among them.
  options.least_fraction = std::min(options.least_fraction, 0.5 / patches);
  options.most_fraction = std::min(options.most_fraction, 0.9 / patches);
  options.across_cusp = patches > kBesideCusp;
  std::vector<test::Scene> scenes;
  for (int i = 0; i < std::max(8, 2 * kScenes / patches); ++i) {
    scenes.push_back(test::random_scene(curve_class, options, rng));
  }
  return scenes;
}

/// 2 x 111 samples of each class.
void cold(benchmark::State& state) {
  const auto curve_class = static_cast<CurveClass>(state.range(0));
  state.SetLabel(std::string(name_of(curve_class)));
  const auto scenes = scenes_of(curve_class, 111, 2);
  std::size_t i = 0;
  for (auto _ : state) {
    const test::Scene& scene = scenes[i++ % scenes.size()];
    benchmark::DoNotOptimize(test::recognise(scene, scene.sigma_m));
  }
}
BENCHMARK(cold)->DenseRange(1, 8)->Unit(benchmark::kMicrosecond);

/// Of an ellipse, by what is told.
void cold_told(benchmark::State& state, bool noise_is_stated, std::optional<bool> unqualified) {
  const auto scenes = scenes_of(CurveClass::Ellipse, 111, 2);
  RecognizerOptions options;
  options.unqualified_probe = unqualified;
  std::size_t i = 0;
  for (auto _ : state) {
    const test::Scene& scene = scenes[i++ % scenes.size()];
    benchmark::DoNotOptimize(
        test::recognise(scene, noise_is_stated ? scene.sigma_m : 0.0, options));
  }
}
BENCHMARK_CAPTURE(cold_told, noise, true, std::nullopt)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(cold_told, noise_alone, false, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(cold_told, nothing, false, std::nullopt)->Unit(benchmark::kMicrosecond);

/// By the total number of samples, in two patches of an ellipse.
void cold_by_samples(benchmark::State& state) {
  const auto scenes = scenes_of(CurveClass::Ellipse, static_cast<int>(state.range(0)) / 2, 2);
  std::size_t i = 0;
  for (auto _ : state) {
    const test::Scene& scene = scenes[i++ % scenes.size()];
    benchmark::DoNotOptimize(test::recognise(scene, scene.sigma_m));
  }
  state.SetComplexityN(state.range(0));
}
BENCHMARK(cold_by_samples)
    ->RangeMultiplier(2)
    ->Range(64, 2048)
    ->Unit(benchmark::kMicrosecond)
    ->Complexity(benchmark::oN);

/// Samples [begin, end) of a patch.
void add(const test::Scene& scene, std::size_t patch, std::size_t begin, std::size_t end,
         Recognizer* recognizer) {
  std::vector<ContactSample> samples;
  for (std::size_t i = begin; i < std::min(end, scene.patches[patch].size()); ++i) {
    samples.push_back({scene.patches[patch][i], scene.sigma_m, 0});
  }
  PatchContext context;
  context.patch = static_cast<std::uint32_t>(patch);
  recognizer->add(context, samples);
}

constexpr std::size_t kBatch = 10;

/// The answer for 222 samples from a recognizer that has answered for 212.
void warm(benchmark::State& state) {
  const auto curve_class = static_cast<CurveClass>(state.range(0));
  state.SetLabel(std::string(name_of(curve_class)));
  const auto scenes = scenes_of(curve_class, 111, 2);
  std::size_t number = 0;
  for (auto _ : state) {
    const test::Scene& scene = scenes[number++ % scenes.size()];
    const std::size_t whole = scene.patches[1].size();
    Recognizer recognizer;
    add(scene, 0, 0, scene.patches[0].size(), &recognizer);
    add(scene, 1, 0, whole - kBatch, &recognizer);
    benchmark::DoNotOptimize(recognizer.recognize());
    const auto start = std::chrono::steady_clock::now();
    add(scene, 1, whole - kBatch, whole, &recognizer);
    benchmark::DoNotOptimize(recognizer.recognize());
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    state.SetIterationTime(taken.count());
  }
}
BENCHMARK(warm)->DenseRange(1, 8)->UseManualTime()->Unit(benchmark::kMicrosecond);

/// A whole scene as it arrives, ten samples at a time; time per answer, including searches.
void stream(benchmark::State& state) {
  const auto curve_class = static_cast<CurveClass>(state.range(0));
  state.SetLabel(std::string(name_of(curve_class)));
  const auto scenes = scenes_of(curve_class, 111, 2);
  std::size_t number = 0;
  Recognizer recognizer;
  std::size_t patch = 0;
  std::size_t taken = 0;
  for (auto _ : state) {
    const test::Scene& scene = scenes[number % scenes.size()];
    add(scene, patch, taken, taken + kBatch, &recognizer);
    benchmark::DoNotOptimize(recognizer.recognize());
    taken += kBatch;
    if (taken >= scene.patches[patch].size()) {
      taken = 0;
      if (++patch == scene.patches.size()) {
        patch = 0;
        ++number;
        recognizer.reset();
      }
    }
  }
}
BENCHMARK(stream)->DenseRange(1, 8)->Unit(benchmark::kMicrosecond);

/// The time of the tree in addition to an answer, for so many patches of 111 samples.
void live_tree(benchmark::State& state) {
  const auto curve_class = static_cast<CurveClass>(state.range(0));
  std::vector<test::AnsweredScene> scenes;
  std::size_t contacts = 0;
  for (const test::Scene& scene : scenes_of(curve_class, 111, static_cast<int>(state.range(1)))) {
    scenes.push_back(test::answered(scene));
    contacts += scenes.back().contacts.size();
  }
  std::size_t i = 0;
  for (auto _ : state) {
    const test::AnsweredScene& scene = scenes[i++ % scenes.size()];
    benchmark::DoNotOptimize(reported_tree_path(scene.weighing, scene.contacts, {}));
  }
  state.SetLabel(std::string(name_of(curve_class)) + ", " +
                 std::to_string(contacts / scenes.size()) + " contacts");
}
BENCHMARK(live_tree)
    ->ArgsProduct({{1, 2, 3, 4, 5, 6, 7, 8}, {2, 8, 16, 64}})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace palpate
