// Counts how often the search for a class's optimum misses it, compared with the optimum reached
// from the truth (tests/support/search_outcome.h). Prints tables by class, patches and noise.
//   bench_search [--touches] [--scenes N] [--seed S] [--list]
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "tests/bench/options/bench_options.h"
#include "tests/support/search_outcome.h"

namespace {

using namespace palpate;

// An optimum counts as missed if its chi-square exceeds the reference by kMissed. Beyond kDecisive,
// odds of 1000, the class can no longer be recognised with certainty.
constexpr double kMissed = 1.0;
const double kDecisive = 2.0 * std::log(1000.0);

constexpr std::array kNoiseBounds = {1e-6, 1e-5, 1e-4, 1e-3, 1e-2};
// Numbers of patches, or of touches, are counted together up to these bounds.
constexpr std::array<std::size_t, 6> kPatchBounds = {1, 2, 3, 4, 5, 6};
constexpr std::array<std::size_t, 6> kTouchBounds = {6, 8, 12, 20, 35, 60};

struct Count {
  int cases = 0;
  int missed = 0;
  int decisive = 0;
  int on_all = 0;
  int refused = 0;

  void add(const test::SearchOutcome& reduced, const test::SearchOutcome& all) {
    refused += reduced.refused ? 1 : 0;
    if (reduced.counted) {
      ++cases;
      missed += reduced.excess() > kMissed ? 1 : 0;
      decisive += reduced.excess() > kDecisive ? 1 : 0;
      on_all += all.counted && all.excess() > kMissed ? 1 : 0;
    }
  }
};

void print(const std::string& title, const Count& count) {
  const double n = std::max(count.cases, 1);
  std::printf("  %-28s %6d | %5d %7.3f %% | %5d %7.3f %% | %5d %7.3f %% | %5d\n", title.c_str(),
              count.cases, count.missed, 100.0 * count.missed / n, count.decisive,
              100.0 * count.decisive / n, count.on_all, 100.0 * count.on_all / n, count.refused);
}

}  // namespace

int main(int argc, char** argv) {
  int scenes = 1000;
  std::uint64_t seed = 2026;
  bool list = false;
  bool touches = false;
  if (const auto end = bench::BenchOptions("How often the search for a class's optimum misses it")
                           .number("--scenes", scenes, "Scenes of each class")
                           .seed(seed)
                           .flag("--touches", touches, "Touches one at a time, in no order")
                           .flag("--list", list, "Print every case missed")
                           .parse(argc, argv)) {
    return *end;
  }

  std::printf(
      "Chi-square above that of the optimum which the truth leads to: on the reduced points by "
      "more "
      "than %.0f and by more\nthan %.1f, and on all points by more than %.0f; optima of the truth "
      "that are refused as not "
      "touchable\n",
      kMissed, kDecisive, kMissed);
  const auto& bounds = touches ? kTouchBounds : kPatchBounds;
  for (const CurveClass curve_class : kCurveClasses) {
    Count all;
    std::array<Count, kPatchBounds.size()> by_patches;
    std::array<Count, kNoiseBounds.size() - 1> by_noise;
    std::array<Count, 2> by_tip;
    for (int i = 0; i < scenes; ++i) {
      const auto number = static_cast<std::uint32_t>(i);
      const auto drawn = touches ? test::lone_search_case(curve_class, seed, number)
                                 : test::search_case(curve_class, seed, number);
      const auto reduced = test::outcome_on_reduced(drawn);
      const auto on_all = test::outcome_on_all(drawn);
      const double sigma = drawn.scene.sigma_m / test::SceneOptions{}.size_m;
      const std::size_t patches = drawn.scene.patches.size();
      std::size_t noise = 0;
      while (noise + 2 < kNoiseBounds.size() && sigma > kNoiseBounds[noise + 1]) {
        ++noise;
      }
      all.add(reduced, on_all);
      std::size_t bin = 0;
      while (bin + 1 < bounds.size() && patches > bounds[bin]) ++bin;
      by_patches[bin].add(reduced, on_all);
      by_noise[noise].add(reduced, on_all);
      by_tip[drawn.tip_radius_m > 0.0 ? 1 : 0].add(reduced, on_all);
      if (list && reduced.refused) {
        std::printf("  refused: %d, %zu patches of %zu, sigma/size %.1e%s\n", i, patches,
                    drawn.scene.patches.front().size(), sigma,
                    drawn.tip_radius_m > 0.0 ? ", tip" : "");
      }
      if (list && reduced.counted &&
          (reduced.excess() > kMissed || (on_all.counted && on_all.excess() > kMissed))) {
        std::printf(
            "  missed: %d, %zu patches of %zu, sigma/size %.1e%s: %.6g over %.6g; all %.6g over "
            "%.6g\n",
            i, patches, drawn.scene.patches.front().size(), sigma,
            drawn.tip_radius_m > 0.0 ? ", tip" : "", reduced.found_chi2, reduced.truth_chi2,
            on_all.found_chi2, on_all.truth_chi2);
      }
    }
    std::printf("%s\n", std::string(name_of(curve_class)).c_str());
    print("all", all);
    for (std::size_t p = 0; p < by_patches.size(); ++p) {
      print("up to " + std::to_string(bounds[p]) + (touches ? " touches" : " patches"),
            by_patches[p]);
    }
    for (std::size_t k = 0; k < by_noise.size(); ++k) {
      char title[40];
      std::snprintf(title, sizeof(title), "noise %.0e to %.0e", kNoiseBounds[k],
                    kNoiseBounds[k + 1]);
      print(title, by_noise[k]);
    }
    print("surface points", by_tip[0]);
    print("tips", by_tip[1]);
  }
  return 0;
}
