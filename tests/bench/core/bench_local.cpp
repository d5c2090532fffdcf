// Time of the local estimators: per estimate over 111 samples, and per sample along a stroke.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "core/local/estimator.h"
#include "core/local/noise.h"
#include "core/local/spikes/spikes.h"
#include "core/local/stream/sliding_window.h"
#include "core/local/stream/window_fit.h"

namespace palpate {
namespace {

constexpr double kSigma = 5e-5;

/// Samples 0.2 mm apart along a circle of 25 mm, with noise.
std::vector<Vec2> arc(int count) {
  std::mt19937_64 rng(1);
  std::normal_distribution<double> normal(0.0, kSigma);
  std::vector<Vec2> samples;
  for (int i = 0; i < count; ++i) {
    const double angle = 0.008 * i;
    samples.emplace_back(0.025 * std::cos(angle) + normal(rng),
                         0.025 * std::sin(angle) + normal(rng));
  }
  return samples;
}

EstimatorOptions options_for(const benchmark::State& state) {
  EstimatorOptions options;
  options.kind = static_cast<EstimatorKind>(state.range(0));
  options.sigma_m = kSigma;
  options.window = options.kind == EstimatorKind::TwoRound ? 75 : 111;
  return options;
}

void per_estimate(benchmark::State& state) {
  const std::vector<Vec2> samples = arc(111);
  const EstimatorOptions options = options_for(state);
  state.SetLabel(std::string(name_of(options.kind)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(estimate_window(samples, options));
  }
}
BENCHMARK(per_estimate)->DenseRange(0, 3)->Unit(benchmark::kMicrosecond);

/// By window. The shift is 4 as in the paper, so every fourth sample gives an estimate.
void fixed_window_per_sample(benchmark::State& state) {
  const std::vector<Vec2> samples = arc(4000);
  EstimatorOptions options = options_for(state);
  options.window = static_cast<int>(state.range(1));
  state.SetLabel(std::string(name_of(options.kind)));
  const std::size_t held = samples_per_estimate(options);
  std::size_t end = held;
  for (auto _ : state) {
    if (end % static_cast<std::size_t>(options.shift) == 0) {
      const auto window = std::span(samples).subspan(end - held, held);
      benchmark::DoNotOptimize(estimate_window(window, options));
    }
    end = end == samples.size() ? held : end + 1;
  }
}
BENCHMARK(fixed_window_per_sample)->ArgsProduct({{0, 1, 2, 3}, {15, 31, 51, 75, 111, 151}});

/// The window chosen from the data, along circles on which it contains more and more samples; the
/// label is their mean number. The shift is 4, so every fourth sample gives an estimate.
void sliding_window_per_sample(benchmark::State& state) {
  const auto per_radian = static_cast<double>(state.range(0));
  std::mt19937_64 rng(1);
  std::normal_distribution<double> normal(0.0, kSigma);
  std::vector<Vec2> samples;
  for (int i = 0; i < 8000; ++i) {
    const double angle = i / per_radian;
    samples.emplace_back(0.025 * std::cos(angle) + normal(rng),
                         0.025 * std::sin(angle) + normal(rng));
  }
  SlidingWindow window({.sigma_m = kSigma});
  std::size_t i = 0;
  double held = 0.0;
  double estimates = 0.0;
  for (auto _ : state) {
    if (i == samples.size()) {
      i = 0;
      window.reset();
    }
    if (const auto estimate = window.add(samples[i++])) {
      held += static_cast<double>(estimate->end_sample - estimate->first_sample);
      estimates += 1.0;
    }
  }
  state.SetLabel(std::to_string(std::lround(held / std::max(estimates, 1.0))) + " samples");
}
BENCHMARK(sliding_window_per_sample)->Arg(25)->Arg(50)->Arg(100)->Arg(200)->Arg(400);

void jet_degree(benchmark::State& state) {
  const std::vector<Vec2> samples = arc(111);
  EstimatorOptions options;
  options.sigma_m = kSigma;
  options.jet_degree = static_cast<int>(state.range(0));
  for (auto _ : state) {
    benchmark::DoNotOptimize(estimate_window(samples, options));
  }
}
BENCHMARK(jet_degree)->DenseRange(3, 5)->Unit(benchmark::kMicrosecond);

/// One window of the sliding window, with as many nodes as its pyramid makes of 111 samples.
void window_fit(benchmark::State& state) {
  NodePyramid pyramid;
  for (const Vec2& p : arc(111)) {
    pyramid.add(p, 1.0);
  }
  std::vector<PathNode> nodes;
  pyramid.window(0, &nodes);
  for (auto _ : state) {
    benchmark::DoNotOptimize(fit_window(nodes, kSigma, 0.0));
  }
}
BENCHMARK(window_fit)->Unit(benchmark::kMicrosecond);

void noise_of_a_patch(benchmark::State& state) {
  const std::vector<Vec2> samples = arc(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(estimate_noise(samples));
  }
}
BENCHMARK(noise_of_a_patch)->Arg(111)->Arg(222)->Unit(benchmark::kMicrosecond);

void spikes_of_a_patch(benchmark::State& state) {
  const std::vector<Vec2> samples = arc(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(find_spikes(samples, {.sigma_m = kSigma}));
  }
}
BENCHMARK(spikes_of_a_patch)->Arg(111)->Arg(222)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace palpate
