// The recognition tree compared with the posterior on scenes drawn from a stated prior
// (tests/support/scene_prior.h): how often its tests reject the true class (expected: as often as
// their significance says), and which class it reaches. Prints tables.
//   bench_tree [--scenes N] [--seed S]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "core/recognition/recognizer.h"
#include "tests/bench/options/bench_options.h"
#include "tests/support/scene_data.h"
#include "tests/support/scene_prior.h"

namespace {

using namespace palpate;

/// Scenes of one row.
struct Cell {
  int scenes = 0, recognized = 0, asked = 0, rejected = 0, reached = 0, other = 0;
  int recognized_rejected = 0;
  std::map<std::string, int> by_test;
};

std::string decade_of(double noise) {
  char text[32];
  std::snprintf(text, sizeof(text), "noise %.0e", std::pow(10.0, std::floor(std::log10(noise))));
  return text;
}

void print(const std::string& title, const Cell& cell) {
  std::printf("  %-24s %6d %6d | %6d %6d (%5.2f %%) | %6d %6d | %6d", title.c_str(), cell.scenes,
              cell.recognized, cell.asked, cell.rejected,
              cell.asked > 0 ? 100.0 * cell.rejected / cell.asked : 0.0, cell.reached, cell.other,
              cell.recognized_rejected);
  for (const auto& [test, count] : cell.by_test) std::printf("  %s %d", test.c_str(), count);
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  int scenes = 2000;
  std::uint64_t seed = 2026;
  if (const auto end = bench::BenchOptions("The recognition tree beside the posterior")
                           .number("--scenes", scenes, "Number of scenes")
                           .seed(seed)
                           .parse(argc, argv)) {
    return *end;
  }
  const test::ScenePrior prior = test::classes_only(test::even_prior());
  const double significance = RecognizerOptions{}.tree.significance;
  std::map<CurveClass, Cell> classes;
  std::map<std::string, Cell> noises;
  Cell all;
  for (int i = 0; i < scenes; ++i) {
    const test::PriorScene scene = test::scene_from(prior, seed, static_cast<std::uint32_t>(i));
    Recognizer recognizer;
    test::add_scene(scene.scene, scene.scene.sigma_m, &recognizer);
    const Recognition answer = recognizer.recognize();
    const CurveClass truth = scene.scene.curve_class;
    const double p = answer.tree_p_values[static_cast<std::size_t>(truth)];
    for (Cell* cell :
         {&all, &classes[truth], &noises[decade_of(scene.scene.sigma_m / scene.size_m)]}) {
      ++cell->scenes;
      // RECOGNIZED, or it would be without the tree.
      const bool right =
          answer.shape.curve_class == truth &&
          (answer.status == RecognitionStatus::Recognized || answer.doubt == Doubt::TreeRejects);
      cell->recognized += right ? 1 : 0;
      if (answer.decisions.empty()) continue;
      cell->asked += std::isnan(p) ? 0 : 1;
      const bool rejects = p < significance;
      cell->rejected += rejects ? 1 : 0;
      cell->recognized_rejected += rejects && right ? 1 : 0;
      cell->reached += answer.tree_class == truth ? 1 : 0;
      cell->other += answer.tree_class != truth && answer.tree_class != CurveClass::Unclassified;
      if (rejects) {
        for (const Decision& decision : answer.decisions) {
          if (decision.p_value == p) ++cell->by_test[std::string(decision.test)];
        }
      }
    }
  }
  std::printf(
      "Tests of the true class at significance %g: asked, rejected; where the tree ended: in the "
      "true class, in another (a line or\ncircle that the estimates do not tell from it, or any); "
      "RECOGNIZED and rejected; by test\n"
      "  %-24s %6s %6s | %6s %16s | %6s %6s | %6s\n",
      significance, "", "scenes", "recogn", "asked", "rejected", "true", "other", "both");
  print("all", all);
  for (const auto& [curve_class, cell] : classes) print(std::string(name_of(curve_class)), cell);
  for (const auto& [noise, cell] : noises) print(noise, cell);
  return 0;
}
