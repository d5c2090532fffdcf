// Bound on the gain from normals measured along strokes: the Kanatani-Cramer-Rao bound of places
// and normals together over that of the places alone, at the true curve; geometric mean over the
// deviations of the shape parameters, median over the scenes. Each sample has its own normal with
// an independent error, so this is the largest possible gain. Prints a table.
//   bench_stroke_normals [--degrees D] [--scenes N] [--curve NAME] [--seed S]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "core/curves/curve.h"
#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/fit/orthogonal/implicit_fit.h"
#include "tests/bench/options/bench_options.h"
#include "tests/support/placed_fit.h"
#include "tests/support/random_scene.h"

namespace {

using namespace palpate;

/// The noise-free places of a scene, as data with that noise, each with its true normal.
FitData data_of(const test::Scene& scene, double sigma_m, double normal_sigma_rad,
                const Curve& curve) {
  SampleMemory memory;
  PatchContext context;
  std::vector<Vec2> normals;
  for (std::size_t p = 0; p < scene.patches.size(); ++p) {
    std::vector<ContactSample> samples;
    for (std::size_t i = 0; i < scene.patches[p].size(); ++i) {
      samples.push_back({scene.patches[p][i], sigma_m, 0});
      const Vec2 along = derivatives(curve, scene.t[p][i]).first.normalized();
      normals.emplace_back(scene.world_T_curve.rotate(left_of(along)));
    }
    context.patch = static_cast<std::uint32_t>(p);
    memory.add(context, samples);
  }
  FitData data = make_fit_data(memory.patches(), 0.0);
  // A normal is used in full only at a patch of one sample, so each sample becomes a patch.
  data.patches.clear();
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    data.patches.push_back({i, i + 1});
    if (normal_sigma_rad > 0.0) {
      data.points[i].normal = data.frame.rotate_back(normals[i]);
      data.points[i].inverse_normal_sigma = 1.0 / normal_sigma_rad;
    }
  }
  return data;
}

/// Sum of the logarithms of the bounds on the shape parameters' deviations; nullopt without a
/// bound.
std::optional<double> log_deviations(const test::Scene& scene, double sigma_m,
                                     double normal_sigma_rad) {
  const auto curve = make_curve(scene.curve_class, scene.values);
  const FitData data = data_of(scene, sigma_m, normal_sigma_rad, *curve);
  std::vector<double> t;
  for (const auto& patch : scene.t) {
    t.insert(t.end(), patch.begin(), patch.end());
  }
  ClassFit at_truth =
      test::placed_fit({scene.curve_class, scene.values}, scene.world_T_curve, data, t);
  if (at_truth.implicit) {
    at_truth.implicit = placed_on(data.points, *std::move(at_truth.implicit));
  }
  const auto canonical = to_canonical(at_truth, data);
  if (!canonical) {
    return std::nullopt;
  }
  double sum = 0.0;
  for (Eigen::Index k = 0; k < canonical->shape.values.size(); ++k) {
    if (k < static_cast<Eigen::Index>(parameter_letters(scene.curve_class).size())) {
      sum += 0.5 * std::log(canonical->covariance(k, k));
    }
  }
  return std::isfinite(sum) ? std::optional(sum) : std::nullopt;
}

/// nullopt if too few scenes have a bound.
std::optional<double> median_ratio(CurveClass curve_class, const test::SceneOptions& options,
                                   double sigma_over_size, double normal_sigma_rad, int scenes,
                                   std::uint64_t seed) {
  std::vector<double> ratios;
  for (int i = 0; i < scenes; ++i) {
    std::seed_seq seeds{seed, static_cast<std::uint64_t>(options.patches),
                        static_cast<std::uint64_t>(options.points_per_patch),
                        static_cast<std::uint64_t>(i)};
    std::mt19937_64 rng(seeds);
    const test::Scene scene = test::random_scene(curve_class, options, rng);
    const double sigma_m = sigma_over_size * options.size_m;
    const auto with = log_deviations(scene, sigma_m, normal_sigma_rad);
    const auto without = log_deviations(scene, sigma_m, 0.0);
    if (with && without) {
      const auto letters = static_cast<double>(parameter_letters(curve_class).size());
      ratios.push_back(std::exp((*with - *without) / letters));
    }
  }
  if (2 * static_cast<int>(ratios.size()) < scenes) {
    return std::nullopt;
  }
  std::sort(ratios.begin(), ratios.end());
  return ratios[ratios.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  double degrees = 1.0;
  int scenes = 40;
  std::uint64_t seed = 2026;
  std::string curve;
  if (const auto end = bench::BenchOptions("What normals along strokes would add, by the bound")
                           .number("--degrees", degrees, "Deviation of a sample's normal [degrees]")
                           .number("--scenes", scenes, "Scenes of each cell")
                           .text("--curve", curve, "This class only")
                           .seed(seed)
                           .parse(argc, argv)) {
    return *end;
  }
  const std::vector<int> counts = {2, 3, 5, 10, 30, 100};
  std::printf("deviations with normals of %g degrees over those without\n", degrees);
  std::printf("%-22s %7s %11s | samples a patch:", "class", "patches", "sigma/size");
  for (const int count : counts) std::printf(" %6d", count);
  std::printf("\n");
  for (const CurveClass curve_class : kCurveClasses) {
    if (curve_class == CurveClass::Line || (!curve.empty() && curve != name_of(curve_class))) {
      continue;  // a line has no shape
    }
    for (const int patches : {1, 3, 6, 12}) {
      for (const double noise : {1e-2, 3e-3, 1e-3, 1e-4, 1e-5}) {
        std::printf("%-22s %7d %11.0e | %16s", std::string(name_of(curve_class)).c_str(), patches,
                    noise, "");
        for (const int count : counts) {
          test::SceneOptions options;
          options.patches = patches;
          options.points_per_patch = count;
          options.most_fraction = std::min(options.most_fraction, 0.8 / patches);
          options.least_fraction = std::min(options.least_fraction, 0.5 * options.most_fraction);
          options.sigma_over_size = 0.0;  // exact places
          const auto ratio =
              patches * count > degrees_of_freedom(curve_class)
                  ? median_ratio(curve_class, options, noise, degrees * kPi / 180.0, scenes, seed)
                  : std::nullopt;
          ratio ? std::printf(" %6.3f", *ratio) : std::printf(" %6s", "-");
        }
        std::printf("\n");
      }
    }
  }
  return 0;
}
