#include "tests/support/search_outcome.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/curves/curve.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/fit/orthogonal/touchable.h"
#include "core/recognition/samples/tips/tip_sides.h"
#include "core/recognition/smooth/smooth_model.h"
#include "tests/support/placed_fit.h"
#include "tests/support/test_rng.h"
#include "tests/support/unbounded_work.h"

namespace palpate::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Replaces surface points by tip centres, outside the bend at the middle of each patch.
void lift_to_tip(double radius_m, Scene* scene, std::vector<MaterialSide>* sides) {
  const auto curve = make_curve(scene->curve_class, scene->values);
  for (std::size_t p = 0; p < scene->patches.size(); ++p) {
    const auto& t = scene->t[p];
    const double travel = t.back() >= t.front() ? 1.0 : -1.0;
    const double bend = travel * geometry(*curve, t[t.size() / 2]).kappa;
    const double side = bend >= 0.0 ? -1.0 : 1.0;  // the side of travel on which the centres lie
    sides->push_back(side > 0.0 ? MaterialSide::Right : MaterialSide::Left);
    for (std::size_t i = 0; i < t.size(); ++i) {
      const Vec2 tangent = travel * derivatives(*curve, t[i]).first.normalized();
      scene->patches[p][i] += side * radius_m * scene->world_T_curve.rotate(left_of(tangent));
    }
  }
}

struct Prepared {
  FitData data;
  SmoothModel smooth;
  FitData reduced;  ///< surface points
};

Prepared prepare(const SearchCase& search_case) {
  Scene scene = search_case.scene;
  std::vector<MaterialSide> sides(scene.patches.size(), MaterialSide::Unspecified);
  if (search_case.tip_radius_m > 0.0) {
    sides.clear();
    lift_to_tip(search_case.tip_radius_m, &scene, &sides);
  }
  SampleMemory memory;
  for (std::size_t p = 0; p < scene.patches.size(); ++p) {
    std::vector<ContactSample> samples;
    for (const Vec2& position : scene.patches[p]) {
      samples.push_back({position, scene.sigma_m, 0});
    }
    memory.add({0, static_cast<std::uint32_t>(p), search_case.tip_radius_m, sides[p]}, samples);
  }
  Prepared prepared;
  prepared.data = make_fit_data(memory.patches(), 0.0);
  prepared.smooth = fit_smooth_model(&prepared.data, prepared.data.noise_is_stated);
  WorkBudget unbounded;
  const auto possible = possible_sides(memory.patches(), prepared.smooth.reduced,
                                       turns_of(prepared.smooth.reduced), {}, unbounded);
  prepared.reduced = on_surface(prepared.smooth.reduced, possible.ways.front());
  return prepared;
}

/// The true curve in the frame of the data, as a fit to the reduced points.
ClassFit truth_of(const Scene& scene, const Prepared& prepared) {
  const FitData& reduced = prepared.reduced;
  // Curve parameters: those of the nearest samples of the same patch.
  std::vector<double> t;
  for (std::size_t p = 0; p < reduced.patches.size(); ++p) {
    const auto samples = prepared.data.patch(p);
    for (const FitPoint& point : reduced.patch(p)) {
      const auto nearest =
          std::min_element(samples.begin(), samples.end(), [&](const auto& a, const auto& b) {
            return (a.position - point.position).squaredNorm() <
                   (b.position - point.position).squaredNorm();
          });
      t.push_back(scene.t[p][static_cast<std::size_t>(nearest - samples.begin())]);
    }
  }
  return placed_fit({scene.curve_class, scene.values}, scene.world_T_curve, reduced, t);
}

double chi2_of(const std::optional<ClassFit>& fit) { return fit ? fit->chi2 : kInfinity; }

/// True if a conic has not left its class.
bool is_still(CurveClass curve_class, const ClassFit& fit) {
  const bool ellipse = curve_class == CurveClass::Ellipse;
  return (!ellipse && curve_class != CurveClass::Hyperbola) ||
         (discriminant(fit.implicit->coefficients) > 0.0) == ellipse;
}

SearchOutcome outcome(const SearchCase& search_case, bool on_all) {
  const Prepared prepared = prepare(search_case);
  const auto optimum = [&](const ClassFit& start) -> std::optional<ClassFit> {
    const ClassFit there = settled(start, prepared.reduced, RivalOf::Best, test::unbounded_work());
    if (!is_what_it_says(there, prepared.reduced)) {
      return std::nullopt;
    }
    return on_all ? refine_on_all(there, prepared.smooth, prepared.data, kPolishEffort,
                                  test::unbounded_work())
                  : std::optional(there);
  };
  SearchOutcome result;
  const ClassFit start = truth_of(search_case.scene, prepared);
  const auto truth = optimum(start);
  result.counted = truth.has_value();
  result.refused =
      !truth && is_still(search_case.scene.curve_class,
                         settled(start, prepared.reduced, RivalOf::Best, test::unbounded_work()));
  result.truth_chi2 = chi2_of(truth);
  const auto i = static_cast<std::size_t>(search_case.scene.curve_class);
  const auto found = fit_classes(prepared.reduced, test::unbounded_work())[i];
  result.found_chi2 = found ? chi2_of(optimum(*found)) : kInfinity;
  result.curve = std::isfinite(result.found_chi2);
  return result;
}

}  // namespace

SearchCase search_case(CurveClass curve_class, std::uint64_t seed, std::uint32_t number) {
  std::mt19937_64 rng = seeded_rng(seed, {static_cast<std::uint32_t>(curve_class), number});
  SceneOptions options;
  options.patches = std::uniform_int_distribution<int>(1, 6)(rng);
  options.points_per_patch = static_cast<int>(std::lround(log_uniform(rng, 10.0, 200.0)));
  options.sigma_over_size = log_uniform(rng, 1e-6, 1e-2);
  options.least_arc_over_size = 0.05;
  options.most_arc_over_size = 4.0;
  SearchCase result;
  const bool tip = std::uniform_int_distribution<int>(0, 3)(rng) == 0;
  const double radius = options.size_m * log_uniform(rng, 1e-3, 1e-1);
  result.tip_radius_m = tip ? radius : 0.0;
  result.scene = random_scene(curve_class, options, rng);
  return result;
}

SearchCase lone_search_case(CurveClass curve_class, std::uint64_t seed, std::uint32_t number) {
  // A different sequence from that of search_case.
  constexpr std::uint32_t kLone = 0x10e;
  std::mt19937_64 rng = seeded_rng(seed, {static_cast<std::uint32_t>(curve_class), number, kLone});
  constexpr double kMostTouches = 60.0;
  const double fewest = degrees_of_freedom(curve_class) + 1.0;
  const auto count = static_cast<std::size_t>(std::lround(log_uniform(rng, fewest, kMostTouches)));
  SceneOptions options;
  options.patches = std::uniform_int_distribution<int>(1, 3)(rng);
  options.points_per_patch = 200;
  options.sigma_over_size = log_uniform(rng, 1e-6, 1e-2);
  options.least_arc_over_size = 0.05;
  options.most_arc_over_size = 4.0;
  options.across_cusp = true;
  const Scene strokes = random_scene(curve_class, options, rng);
  std::vector<std::pair<Vec2, double>> places;
  for (std::size_t p = 0; p < strokes.patches.size(); ++p) {
    for (std::size_t i = 0; i < strokes.patches[p].size(); ++i) {
      places.emplace_back(strokes.patches[p][i], strokes.t[p][i]);
    }
  }
  std::shuffle(places.begin(), places.end(), rng);
  SearchCase result;
  result.scene = strokes;
  result.scene.patches.clear();
  result.scene.t.clear();
  for (std::size_t k = 0; k < count; ++k) {
    result.scene.patches.push_back({places[k].first});
    result.scene.t.push_back({places[k].second});
  }
  return result;
}

SearchOutcome outcome_on_reduced(const SearchCase& search_case) {
  return outcome(search_case, false);
}

SearchOutcome outcome_on_all(const SearchCase& search_case) { return outcome(search_case, true); }

}  // namespace palpate::test
