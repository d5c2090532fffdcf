// Time of each invariant and fit: bench_invariants
#include <benchmark/benchmark.h>

#include <random>

#include "core/invariants/conic_invariants.h"
#include "core/invariants/conic_line.h"
#include "core/invariants/conic_parameters.h"
#include "core/invariants/cubical_parabola_invariants.h"
#include "core/invariants/parabola_invariant.h"
#include "core/invariants/semi_cubical_parabola_invariants.h"
#include "core/invariants/signature_fit/parabola_fits.h"
#include "core/invariants/signature_fit/spline_least_squares.h"
#include "core/recognition/tree/recognition_tree.h"
#include "tests/support/canonical_points.h"

namespace palpate {
namespace {

/// Points of a random curve of the class, with 1 % of noise stated by the covariance.
std::vector<TreePoint> tree_points(CurveClass curve_class, int count) {
  std::mt19937_64 rng(7);
  const test::PlacedCurve curve = test::random_curve(curve_class, rng);
  auto points = test::exact_points(curve, test::random_places(curve, count, rng), rng);
  for (TreePoint& point : points) {
    point.estimate.covariance.diagonal() << 1e-10, 1e-8, 1e-6, 1e-5;
  }
  return points;
}

std::vector<MeasuredGeometry> points(CurveClass curve_class, int count) {
  return test::measured(tree_points(curve_class, count));
}

void parabola_invariant_ip(benchmark::State& state) {
  const auto p = points(CurveClass::Parabola, 1);
  for (auto _ : state) {
    benchmark::DoNotOptimize(p.data());
    benchmark::DoNotOptimize(parabola_invariant(p[0].kappa, p[0].kappa_s));
  }
}
BENCHMARK(parabola_invariant_ip);

void conic_pair_with_covariance(benchmark::State& state) {
  const auto p = points(CurveClass::Ellipse, 2);
  for (auto _ : state) {
    benchmark::DoNotOptimize(conic_invariants(p[0], p[1]));
  }
}
BENCHMARK(conic_pair_with_covariance);

void ellipse_parameters_with_covariance(benchmark::State& state) {
  const Eigen::Matrix2d covariance = 1e-6 * Eigen::Matrix2d::Identity();
  for (auto _ : state) {
    benchmark::DoNotOptimize(ellipse_parameters(0.1857, 1.2055, covariance));
  }
}
BENCHMARK(ellipse_parameters_with_covariance);

void conic_line_of_n(benchmark::State& state) {
  const auto p = points(CurveClass::Ellipse, static_cast<int>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(fit_conic_line(p));
  }
}
BENCHMARK(conic_line_of_n)->Arg(3)->Arg(10)->Arg(100);

void cubical_parabola_pair_with_covariance(benchmark::State& state) {
  const auto p = points(CurveClass::CubicalParabola, 2);
  for (auto _ : state) {
    benchmark::DoNotOptimize(cubical_parabola_pair(p[0], p[1]));
  }
}
BENCHMARK(cubical_parabola_pair_with_covariance);

void semi_cubical_parabola_pair_with_covariance(benchmark::State& state) {
  const auto p = points(CurveClass::SemiCubicalParabola, 2);
  for (auto _ : state) {
    benchmark::DoNotOptimize(semi_cubical_parabola_pair(p[0], p[1]));
  }
}
BENCHMARK(semi_cubical_parabola_pair_with_covariance);

void cubical_parabola_fit_of_n(benchmark::State& state) {
  const auto p = points(CurveClass::CubicalParabola, static_cast<int>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(fit_cubical_parabola(p));
  }
}
BENCHMARK(cubical_parabola_fit_of_n)->Arg(3)->Arg(10)->Unit(benchmark::kMicrosecond);

void spline_least_squares_of_n(benchmark::State& state) {
  const auto p = points(CurveClass::CubicSpline, static_cast<int>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(spline_least_squares(p));
  }
}
BENCHMARK(spline_least_squares_of_n)->DenseRange(3, 5)->Unit(benchmark::kMicrosecond);

void spline_fit_of_n(benchmark::State& state) {
  const auto p = points(CurveClass::CubicSpline, static_cast<int>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(fit_cubic_spline(p));
  }
}
BENCHMARK(spline_fit_of_n)->DenseRange(3, 5)->Unit(benchmark::kMicrosecond);

void recognition_tree_of_five(benchmark::State& state) {
  const auto curve_class = static_cast<CurveClass>(state.range(0));
  const auto p = tree_points(curve_class, 5);
  for (auto _ : state) {
    benchmark::DoNotOptimize(recognise_by_tree(p));
  }
  state.SetLabel(std::string(name_of(curve_class)));
}
BENCHMARK(recognition_tree_of_five)
    ->DenseRange(static_cast<int>(CurveClass::Ellipse), static_cast<int>(CurveClass::CubicSpline))
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace palpate
