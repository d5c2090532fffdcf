// Time of each function of a curve, by class: bench_curves
#include <benchmark/benchmark.h>

#include <array>
#include <random>
#include <string>

#include "core/curves/curve.h"

namespace palpate {
namespace {

/// A curve of the class given by the benchmark's argument, and points all around it, used in turn.
struct Case {
  explicit Case(benchmark::State& state)
      : curve(*make_curve(static_cast<CurveClass>(state.range(0)), {1.3, 0.7, 0.4})) {
    state.SetLabel(std::string(name_of(class_of(curve))));
    std::mt19937_64 rng(1);
    std::uniform_real_distribution<double> coordinate(-2.0, 2.0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] = {coordinate(rng), coordinate(rng)};
      parameters[i] = coordinate(rng);
    }
  }

  std::size_t next() { return index++ % points.size(); }

  Curve curve;
  std::array<Vec2, 1024> points;
  std::array<double, 1024> parameters;
  std::size_t index = 0;
};

void all_classes(benchmark::internal::Benchmark* benchmark) {
  benchmark->DenseRange(static_cast<int>(CurveClass::Line),
                        static_cast<int>(CurveClass::CubicSpline));
}

void curve_geometry(benchmark::State& state) {
  Case c(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(geometry(c.curve, c.parameters[c.next()]));
  }
}
BENCHMARK(curve_geometry)->Apply(all_classes);

void curve_foot_point(benchmark::State& state) {
  Case c(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(foot_point(c.curve, c.points[c.next()]));
  }
}
BENCHMARK(curve_foot_point)->Apply(all_classes);

/// A path 1 mm from the curve; each search starts 0.01 from the foot point.
void curve_foot_point_near(benchmark::State& state) {
  Case c(state);
  for (std::size_t i = 0; i < c.points.size(); ++i) {
    c.points[i] = position(c.curve, c.parameters[i]) + Vec2(1e-3, 0.0);
  }
  for (auto _ : state) {
    const std::size_t i = c.next();
    benchmark::DoNotOptimize(foot_point_near(c.curve, c.points[i], c.parameters[i] + 0.01));
  }
}
BENCHMARK(curve_foot_point_near)->Apply(all_classes);

void curve_arc_length(benchmark::State& state) {
  Case c(state);
  for (auto _ : state) {
    const std::size_t i = c.next();
    benchmark::DoNotOptimize(arc_length(c.curve, c.parameters[i], c.points[i].x()));
  }
}
BENCHMARK(curve_arc_length)->Apply(all_classes);

/// A step of 10 mm, as between samples.
void curve_parameter_at_arc_length(benchmark::State& state) {
  Case c(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(parameter_at_arc_length(c.curve, c.parameters[c.next()], 0.01));
  }
}
BENCHMARK(curve_parameter_at_arc_length)->Apply(all_classes);

void curve_localise(benchmark::State& state) {
  Case c(state);
  std::array<LocalGeometry, 1024> measured;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    measured[i] = geometry(c.curve, c.parameters[i]);
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(localise(c.curve, measured[c.next()]));
  }
}
BENCHMARK(curve_localise)->Apply(all_classes);

}  // namespace
}  // namespace palpate
