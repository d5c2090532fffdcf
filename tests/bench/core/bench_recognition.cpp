// Cost of a full recognition, all classes considered: bench_recognition
//   cold: a new recognizer for every scene. Over 64 random scenes of each class, two patches.
//   warm: a stream; the answer is asked again after every ten new samples of a patch that grows.
#include <benchmark/benchmark.h>

#include <random>

#include "core/recognition/class_fits.h"
#include "core/recognition/smooth_model.h"
#include "tests/support/scene_data.h"

namespace palpate {
namespace {

constexpr int kScenes = 64;

std::vector<test::Scene> scenes_of(CurveClass curve_class, int points_per_patch, int patches) {
  std::mt19937_64 rng(11);
  test::SceneOptions options;
  options.points_per_patch = points_per_patch;
  options.patches = patches;
  std::vector<test::Scene> scenes;
  for (int i = 0; i < kScenes; ++i) {
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

/// Samples of two patches of an ellipse in all.
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

/// One whole patch in memory, the second arriving ten samples at a time.
void warm(benchmark::State& state) {
  const auto curve_class = static_cast<CurveClass>(state.range(0));
  state.SetLabel(std::string(name_of(curve_class)));
  constexpr std::size_t kBatch = 10;
  const auto scenes = scenes_of(curve_class, 111, 2);
  std::size_t scene_number = 0;
  std::size_t taken = 0;
  Recognizer recognizer;
  const auto add = [&](const test::Scene& scene, std::size_t patch, std::size_t begin,
                       std::size_t end) {
    std::vector<ContactSample> samples;
    for (std::size_t i = begin; i < std::min(end, scene.patches[patch].size()); ++i) {
      samples.push_back({scene.patches[patch][i], scene.sigma_m, 0});
    }
    PatchContext context;
    context.patch = static_cast<std::uint32_t>(patch);
    recognizer.add(context, samples);
  };
  for (auto _ : state) {
    const test::Scene& scene = scenes[scene_number % scenes.size()];
    if (taken == 0) {
      state.PauseTiming();
      recognizer.reset();
      add(scene, 0, 0, scene.patches[0].size());
      add(scene, 1, 0, scene.patches[1].size() / 2);
      taken = scene.patches[1].size() / 2;
      benchmark::DoNotOptimize(recognizer.recognize());
      state.ResumeTiming();
    }
    add(scene, 1, taken, taken + kBatch);
    benchmark::DoNotOptimize(recognizer.recognize());
    taken += kBatch;
    if (taken >= scene.patches[1].size()) {
      taken = 0;
      ++scene_number;
    }
  }
}
BENCHMARK(warm)->DenseRange(1, 8)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace palpate
