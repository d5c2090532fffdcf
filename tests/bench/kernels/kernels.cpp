// Runs each piece of the library on fixed, seeded data, by name, so that compare.sh can count its
// instructions:
//   kernels --list    prints "NAME CALLS" per line; CALLS goes once through all of its data
//   kernels NAME N    runs the kernel N times; without N: CALLS times
// Only what runs inside `palpate_kernel_call` is counted; preparation is outside of it.
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "core/curves/curve.h"
#include "core/invariants/conic_invariants.h"
#include "core/invariants/conic_line.h"
#include "core/invariants/conic_parameters.h"
#include "core/invariants/constant_curvature.h"
#include "core/invariants/cubic_spline_equations.h"
#include "core/invariants/cubical_parabola_invariants.h"
#include "core/invariants/parabola_invariant.h"
#include "core/invariants/semi_cubical_parabola_invariants.h"
#include "core/invariants/signature_fit/parabola_fits.h"
#include "core/invariants/signature_fit/spline_least_squares.h"
#include "core/invariants/spline_pair.h"
#include "core/local/estimator.h"
#include "core/local/noise.h"
#include "core/local/spikes/spikes.h"
#include "core/local/tip_radius.h"
#include "core/recognition/fit/orthogonal/implicit_fit.h"
#include "core/recognition/reported_tree_path.h"
#include "core/recognition/samples/sample_memory.h"
#include "tests/support/answered_scene.h"
#include "tests/support/canonical_points.h"
#include "tests/support/fit_samples.h"
#include "tests/support/scene_data.h"

/// The function whose instructions are counted (compare.sh names it): call number i of a kernel.
/// The barrier prevents a tail call, after which this function would never return.
extern "C" [[gnu::noinline]] void palpate_kernel_call(const std::function<void(std::size_t)>& call,
                                                      std::size_t i) {
  call(i);
  asm volatile("" : : : "memory");
}

namespace palpate {
namespace {

using Call = std::function<void(std::size_t)>;

/// A kernel with its data.
struct Prepared {
  Call call;
  Call before;  ///< not counted: what call i needs, if anything
};

struct Kernel {
  std::string name;
  int calls = 1;  ///< number of calls after which the data repeat
  std::function<Prepared()> prepare;
};

/// Forces the compiler to compute the value.
template <typename T>
void keep(const T& value) {
  asm volatile("" : : "r"(&value) : "memory");
}

/// The kernel `function(datum)` over the data that `make` returns.
template <typename Make, typename Function>
Kernel over(std::string name, int calls, Make make, Function function) {
  return {std::move(name), calls, [=] {
            return Prepared{
                [data = make(), function](std::size_t i) { keep(function(data[i % data.size()])); },
                {}};
          }};
}

// --- Local estimators

constexpr double kSigma = 5e-5;  // [m]
constexpr int kWindows = 16;
constexpr std::size_t kWindowSamples = 111;

/// Windows all around an ellipse of 25 and 17.5 mm, 0.2 mm between samples.
std::vector<std::vector<Vec2>> windows() {
  const Ellipse ellipse{0.025, 0.0175};
  std::mt19937_64 rng(1);
  std::normal_distribution<double> noise(0.0, kSigma);
  std::vector<std::vector<Vec2>> all(kWindows);
  for (int w = 0; w < kWindows; ++w) {
    const double start = 2.0 * kPi * w / kWindows;
    for (std::size_t i = 0; i < kWindowSamples; ++i) {
      const double t = ellipse.parameter_at_arc_length(start, 2e-4 * static_cast<double>(i));
      const double dx = noise(rng);
      const double dy = noise(rng);
      all[static_cast<std::size_t>(w)].push_back(ellipse.position(t) + Vec2(dx, dy));
    }
  }
  return all;
}

/// The same with a tenth of the samples up to 5 mm off.
std::vector<std::vector<Vec2>> spiked_windows() {
  std::vector<std::vector<Vec2>> all = windows();
  std::mt19937_64 rng(2);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (auto& window : all) {
    for (Vec2& p : window) {
      const double chance = uniform(rng);
      const double x = uniform(rng) - 0.5;
      const double y = uniform(rng) - 0.5;
      if (chance < 0.1) {
        p += 0.01 * Vec2(x, y);
      }
    }
  }
  return all;
}

void add_local(std::vector<Kernel>* kernels) {
  const auto add = [&](const std::string& name, auto function) {
    kernels->push_back(over("local/" + name, kWindows, windows, function));
  };
  for (const EstimatorKind kind :
       {EstimatorKind::FiniteDifference, EstimatorKind::Circle, EstimatorKind::TwoRound}) {
    EstimatorOptions options;
    options.kind = kind;
    options.sigma_m = kSigma;
    options.window = kind == EstimatorKind::TwoRound ? 75 : static_cast<int>(kWindowSamples);
    add(std::string(name_of(kind)), [=](const auto& w) { return estimate_window(w, options); });
  }
  for (const int degree : {3, 4, 5}) {
    EstimatorOptions options;
    options.sigma_m = kSigma;
    options.jet_degree = degree;
    options.window = static_cast<int>(kWindowSamples);
    add("jet-" + std::to_string(degree),
        [=](const auto& w) { return estimate_window(w, options); });
  }
  const auto window_nodes = [] {
    std::vector<std::vector<PathNode>> all;
    for (const auto& window : windows()) {
      NodePyramid pyramid;
      for (const Vec2& p : window) {
        pyramid.add(p, 1.0);
      }
      pyramid.window(0, &all.emplace_back());
    }
    return all;
  };
  kernels->push_back(over("local/window-fit", kWindows, window_nodes,
                          [](const auto& nodes) { return fit_window(nodes, kSigma, 0.0); }));
  add("noise", [](const auto& w) { return estimate_noise(w); });
  add("spikes", [](const auto& w) { return find_spikes(w, {.sigma_m = kSigma}); });
  add("spikes-noise-unknown", [](const auto& w) { return find_spikes(w); });
  kernels->push_back(over("local/spikes-in-a-tenth", kWindows, spiked_windows,
                          [](const auto& w) { return find_spikes(w); }));
  const auto estimates = [] {
    std::vector<LocalEstimate> all;
    for (const auto& window : windows()) {
      all.push_back(test::fit_samples(window, kSigma).estimate);
    }
    return all;
  };
  constexpr double kTipRadius = 2e-3;  // [m]
  kernels->push_back(over("local/surface-from-tip", kWindows, estimates,
                          [=](const auto& e) { return surface_from_tip(e, -kTipRadius); }));
}

// --- Invariants

constexpr int kCurves = 16;
constexpr int kPoints = 5;

using Points = std::vector<MeasuredGeometry>;

/// Exact points of random curves of the class, with the covariance of about 1 % of noise.
std::vector<Points> points(CurveClass curve_class, int count) {
  std::mt19937_64 rng(7);
  std::vector<Points> all;
  for (int i = 0; i < kCurves; ++i) {
    const test::PlacedCurve curve = test::random_curve(curve_class, rng);
    auto exact = test::exact_points(curve, test::random_places(curve, count, rng), rng);
    for (TreePoint& point : exact) {
      point.estimate.covariance.diagonal() << 1e-10, 1e-8, 1e-6, 1e-5;
    }
    all.push_back(test::measured(exact));
  }
  return all;
}

void add_invariants(std::vector<Kernel>* kernels) {
  const auto add = [&](const char* name, CurveClass curve_class, int count, auto function) {
    kernels->push_back(over(
        std::string("invariants/") + name, kCurves, [=] { return points(curve_class, count); },
        function));
  };
  add("parabola", CurveClass::Parabola, 1,
      [](const Points& p) { return parabola_invariant(p[0].kappa, p[0].kappa_s); });
  add("conic-pair", CurveClass::Ellipse, 2,
      [](const Points& p) { return conic_invariants(p[0], p[1]); });
  add("conic-line-of-5", CurveClass::Ellipse, kPoints,
      [](const Points& p) { return fit_conic_line(p); });
  add("constant-curvature-of-5", CurveClass::Ellipse, kPoints,
      [](const Points& p) { return fit_constant_curvature(p); });
  add("cubical-parabola-pair", CurveClass::CubicalParabola, 2,
      [](const Points& p) { return cubical_parabola_pair(p[0], p[1]); });
  add("semi-cubical-parabola-pair", CurveClass::SemiCubicalParabola, 2,
      [](const Points& p) { return semi_cubical_parabola_pair(p[0], p[1]); });
  add("spline-residual", CurveClass::CubicSpline, 1, [](const Points& p) {
    const auto point = canonical_point(p[0].tangent_angle, p[0].kappa, p[0].kappa_s);
    return spline_residual(spline_point(point, 1.3, 0.4));
  });
  add("spline-c", CurveClass::CubicSpline, 1, [](const Points& p) {
    const auto point = canonical_point(p[0].tangent_angle, p[0].kappa, p[0].kappa_s);
    return spline_c(spline_point(point, 1.3, 0.4), 1.3);
  });
  add("spline-seeds-of-4", CurveClass::CubicSpline, 4,
      [](const Points& p) { return spline_seeds(p, 6); });
  add("spline-least-squares-of-4", CurveClass::CubicSpline, 4,
      [](const Points& p) { return spline_least_squares(p); });
  add("cubical-parabola-fit-of-5", CurveClass::CubicalParabola, kPoints,
      [](const Points& p) { return fit_cubical_parabola(p); });
  add("semi-cubical-parabola-fit-of-5", CurveClass::SemiCubicalParabola, kPoints,
      [](const Points& p) { return fit_semi_cubical_parabola(p); });
  add("cubic-spline-fit-of-5", CurveClass::CubicSpline, kPoints,
      [](const Points& p) { return fit_cubic_spline(p); });

  const auto line_of = [](CurveClass curve_class) {
    std::vector<ConicLine> lines;
    for (const Points& p : points(curve_class, kPoints)) {
      lines.push_back(fit_conic_line(p));
    }
    return lines;
  };
  const auto add_shape = [&](const char* name, CurveClass curve_class, auto function) {
    kernels->push_back(over(
        std::string("invariants/") + name, kCurves, [=] { return line_of(curve_class); },
        function));
  };
  add_shape("ellipse-parameters", CurveClass::Ellipse,
            [](const ConicLine& l) { return ellipse_parameters(l.ic1, l.ic2, l.covariance); });
  add_shape("hyperbola-parameters", CurveClass::Hyperbola,
            [](const ConicLine& l) { return hyperbola_parameters(l.ic1, l.ic2, l.covariance); });
  add_shape("parabola-parameters", CurveClass::Parabola,
            [](const ConicLine& l) { return parabola_parameters(l.ip_mean, l.ip_variance); });
}

// --- Curves

constexpr int kPlaces = 256;

struct Place {
  double t = 0.0;
  Vec2 anywhere = Vec2::Zero();
  Vec2 beside = Vec2::Zero();  ///< 1 mm from the curve's point at t; the curve's size is 1 m
  LocalGeometry local;
};

void add_curves(std::vector<Kernel>* kernels) {
  for (const CurveClass curve_class : kCurveClasses) {
    const Curve curve = *make_curve(curve_class, {1.3, 0.7, 0.4});
    const auto places = [=] {
      std::mt19937_64 rng(1);
      std::uniform_real_distribution<double> coordinate(-2.0, 2.0);
      std::vector<Place> all(kPlaces);
      for (Place& place : all) {
        place.t = coordinate(rng);
        for (double& x : place.anywhere) {
          x = coordinate(rng);
        }
        place.beside = position(curve, place.t) + Vec2(1e-3, 0.0);
        place.local = geometry(curve, place.t);
      }
      return all;
    };
    const auto add = [&](const char* name, auto function) {
      kernels->push_back(
          over(std::string("curves/") + name + '/' + std::string(name_of(curve_class)), kPlaces,
               places, function));
    };
    add("position", [=](const Place& p) { return position(curve, p.t); });
    add("geometry", [=](const Place& p) { return geometry(curve, p.t); });
    // Both also return the signed distance.
    add("foot-point", [=](const Place& p) { return foot_point(curve, p.anywhere); });
    add("foot-point-near",
        [=](const Place& p) { return foot_point_near(curve, p.beside, p.t + 0.01); });
    add("localise", [=](const Place& p) { return localise(curve, p.local); });
  }
  // The distance that refinement needs for a conic, here for points 1 mm from an ellipse.
  const auto beside = [] {
    std::vector<Vec2> all;
    for (int i = 0; i < kPlaces; ++i) {
      const double t = 2.0 * kPi * i / kPlaces;
      all.emplace_back(1.3 * std::cos(t) + 1e-3, 0.7 * std::sin(t));
    }
    return all;
  };
  ConicCoefficients q;
  q << 1.0 / (1.3 * 1.3), 0.0, 1.0 / (0.7 * 0.7), 0.0, 0.0, -1.0;
  kernels->push_back(over("curves/signed-distance/conic", kPlaces, beside, [=](const Vec2& p) {
    Vec2 foot;
    return signed_distance(q, p, &foot);
  }));
}

// --- Recognition, all classes considered

constexpr int kScenes = 16;
constexpr std::size_t kBatch = 10;

std::vector<test::Scene> scenes(CurveClass curve_class) {
  std::mt19937_64 rng(11);
  std::vector<test::Scene> all;
  for (int i = 0; i < kScenes; ++i) {
    all.push_back(test::random_scene(curve_class, {.patches = 2, .points_per_patch = 111}, rng));
  }
  return all;
}

/// The answer for 222 samples from a recognizer that has answered for 212.
Prepared warm(CurveClass curve_class) {
  const auto data = std::make_shared<std::vector<test::Scene>>(scenes(curve_class));
  const auto recognizer = std::make_shared<Recognizer>();
  const auto before = [=](std::size_t i) {
    const test::Scene& scene = (*data)[i % data->size()];
    *recognizer = Recognizer();
    test::add_samples(scene, scene.sigma_m, 0, 0, scene.patches[0].size(), recognizer.get());
    test::add_samples(scene, scene.sigma_m, 1, 0, scene.patches[1].size() - kBatch,
                      recognizer.get());
    keep(recognizer->recognize());
  };
  const auto call = [=](std::size_t i) {
    const test::Scene& scene = (*data)[i % data->size()];
    const std::size_t whole = scene.patches[1].size();
    test::add_samples(scene, scene.sigma_m, 1, whole - kBatch, whole, recognizer.get());
    keep(recognizer->recognize());
  };
  return {call, before};
}

void add_recognition(std::vector<Kernel>* kernels) {
  for (const CurveClass curve_class : kCurveClasses) {
    const std::string name(name_of(curve_class));
    kernels->push_back(over(
        "recognition/cold/" + name, kScenes, [=] { return scenes(curve_class); },
        [](const test::Scene& s) { return test::recognise(s, s.sigma_m); }));
    kernels->push_back({"recognition/warm/" + name, kScenes, [=] { return warm(curve_class); }});
  }
}

/// The tree in addition to an answer for 222 samples.
void add_tree(std::vector<Kernel>* kernels) {
  for (const CurveClass curve_class : kCurveClasses) {
    const auto answered = [=] {
      std::vector<test::AnsweredScene> all;
      for (const test::Scene& scene : scenes(curve_class)) {
        all.push_back(test::answered(scene));
      }
      return all;
    };
    kernels->push_back(over("tree/live/" + std::string(name_of(curve_class)), kScenes, answered,
                            [](const test::AnsweredScene& s) {
                              return reported_tree_path(s.weighing, s.contacts, {});
                            }));
  }
}

/// One more touch for a memory that holds `held`, with room for more or with none.
void add_memory(std::vector<Kernel>* kernels) {
  constexpr int kTouches = 100;
  constexpr std::size_t kRoom = 2000;
  const auto touch = [](SampleMemory* memory, std::size_t i) {
    const ContactSample sample{{1e-3 * static_cast<double>(i), 0.0}, 1e-5, 0};
    return memory->add({.patch = static_cast<std::uint32_t>(i)}, {&sample, 1}).accepted;
  };
  for (const std::size_t held : {std::size_t{1000}, std::size_t{10000}}) {
    for (const bool is_full : {false, true}) {
      const auto prepare = [=]() -> Prepared {
        MemoryOptions options;
        options.most_lone_touches = is_full ? held : held + kRoom;
        const auto memory = std::make_shared<SampleMemory>(options);
        for (std::size_t i = 0; i < held; ++i) touch(memory.get(), i);
        const auto next = std::make_shared<std::size_t>(held);
        return {[=](std::size_t) { keep(touch(memory.get(), (*next)++)); }, {}};
      };
      kernels->push_back({"memory/touch-after-" + std::to_string(held) + (is_full ? "/full" : ""),
                          kTouches, prepare});
    }
  }
}

std::vector<Kernel> all_kernels() {
  // First the cost of calling a kernel, which compare.sh subtracts from the others.
  std::vector<Kernel> kernels = {over(
      "empty", 1, [] { return std::vector<int>(1); }, [](int value) { return value; })};
  add_local(&kernels);
  add_invariants(&kernels);
  add_curves(&kernels);
  add_memory(&kernels);
  add_recognition(&kernels);
  add_tree(&kernels);
  return kernels;
}

void run(const Kernel& kernel, int calls) {
  const Prepared prepared = kernel.prepare();
  const auto before = [&](std::size_t i) {
    if (prepared.before) {
      prepared.before(i);
    }
  };
  before(0);
  prepared.call(0);  // what happens only once is not counted
  for (int i = 0; i < calls; ++i) {
    const auto number = static_cast<std::size_t>(i);
    before(number);
    palpate_kernel_call(prepared.call, number);
  }
}

int run_named(int argc, char** argv) {
  const std::vector<Kernel> kernels = all_kernels();
  const std::string_view name = argc > 1 ? argv[1] : "";
  if (argc == 2 && name == "--list") {
    for (const Kernel& kernel : kernels) {
      std::cout << kernel.name << ' ' << kernel.calls << '\n';
    }
    return 0;
  }
  for (const Kernel& kernel : kernels) {
    if (kernel.name != name || argc > 3) {
      continue;
    }
    int calls = kernel.calls;
    if (argc == 3) {
      const char* end = argv[2] + std::strlen(argv[2]);
      const auto [stop, error] = std::from_chars(argv[2], end, calls);
      if (error != std::errc() || stop != end || calls < 1) {
        std::cerr << "kernels: N must be a whole number of at least 1\n";
        return 2;
      }
    }
    run(kernel, calls);
    return 0;
  }
  std::cerr << "usage: kernels NAME [N] | kernels --list\n";
  return 2;
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) { return palpate::run_named(argc, argv); }
