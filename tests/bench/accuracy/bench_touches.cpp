// Single touches in no order, as a trigger probe delivers them: how often the class is recognised,
// how often wrongly, the errors compared with the published deviations, and the processor time.
// Prints a table.
//   bench_touches [--scenes N] [--count N] [--noise SIGMA_OVER_SIZE] [--normals DEGREES]
//                 [--unstated] [--curve NAME] [--seed S] [--reference]
// --reference: compares with an exhaustive search (tests/support/touch_reference.h), on points of
// stated noise. If the reference says that the touches determine the class: how often it is
// recognised, and how often an optimum was missed. Answers that are sure (P >= 0.95) but not
// RECOGNIZED are counted by cause: fewer than two touches more than the class has unknowns (few);
// two shapes of the class, or a shape not known well enough (both by the reference too); other.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "core/recognition/recognizer.h"
#include "tests/bench/options/bench_options.h"
#include "tests/bench/options/thread_time.h"
#include "tests/support/lone_touches.h"
#include "tests/support/scene_data.h"
#include "tests/support/touch_reference.h"

namespace {

using namespace palpate;
using test::LoneTouches;

struct Cell {
  int scenes = 0, recognized = 0, wrong = 0, sure = 0;
  double squares = 0.0;  ///< of shape errors divided by published deviations
  int letters = 0;
  std::vector<double> ms;
  std::map<std::string, int> by_wrong;
};

LoneTouches scene_of(std::uint64_t seed, CurveClass curve_class, int count, int number,
                     double noise, double tip, std::mt19937_64* rng) {
  std::seed_seq seeds{seed, static_cast<std::uint64_t>(curve_class),
                      static_cast<std::uint64_t>(count), static_cast<std::uint64_t>(number)};
  rng->seed(seeds);
  return test::lone_touches(curve_class, count, noise, tip, *rng);
}

void print_row(const std::string& name, const std::string& count, const test::BesideReference& of) {
  std::printf("%-22s %5s | %6d %10d | %9d %10d | %3d %6d %7d %5d | %5d %6d | %.3f\n", name.c_str(),
              count.c_str(), of.scenes, of.determined, of.sure, of.recognized, of.few_places,
              of.two_shapes, of.shape_unknown, of.other_doubt, of.wrong, of.missed, of.farthest);
}

void print_beside(const std::vector<int>& counts, int scenes, double noise, std::uint64_t seed,
                  const std::string& curve) {
  std::printf("%-22s %5s | %6s %10s | %9s %10s | %3s %6s %7s %5s | %5s %6s | %s\n", "class",
              "count", "scenes", "determined", "P >= 0.95", "RECOGNIZED", "few", "shapes",
              "unknown", "other", "wrong", "missed", "largest change of P");
  test::BesideReference all;
  for (const int count : counts) {
    for (const CurveClass curve_class : kCurveClasses) {
      if (!curve.empty() && curve != name_of(curve_class)) continue;
      test::BesideReference cell;
      std::mt19937_64 rng;
      for (int i = 0; i < scenes; ++i) {
        cell.add(scene_of(seed, curve_class, count, i, noise, 0.0, &rng));
      }
      print_row(std::string(name_of(curve_class)), std::to_string(count), cell);
      all += cell;
    }
  }
  print_row("all", "", all);
}

}  // namespace

int main(int argc, char** argv) {
  int scenes = 50;
  double noise = 1e-4;
  std::uint64_t seed = 2026;
  int count_only = 0;
  bool unstated = false;
  bool reference = false;
  double normals_deg = 0.0;
  std::string curve;
  if (const auto end =
          bench::BenchOptions("Touches one at a time")
              .number("--scenes", scenes, "Number of scenes a row")
              .number("--count", count_only, "Touches of a scene; 0 = 4 to 1000")
              .flag("--reference", reference, "Beside an exhaustive search, by points")
              .flag("--unstated", unstated, "The samples do not state their noise")
              .number("--noise", noise, "Noise over the size")
              .number("--normals", normals_deg, "Deviation of measured normals [degrees]; 0 = none")
              .text("--curve", curve, "This class only")
              .seed(seed)
              .parse(argc, argv)) {
    return *end;
  }
  const std::vector<int> counts = count_only > 0
                                      ? std::vector<int>{count_only}
                                      : std::vector<int>{4, 6, 8, 12, 20, 40, 100, 200, 1000};
  if (reference) {
    print_beside(count_only > 0 ? counts : std::vector<int>{4, 6, 8, 12, 20, 40, 100, 200}, scenes,
                 noise, seed, curve);
    return 0;
  }
  std::printf("%-22s %5s %4s | %6s %5s %5s %5s | %9s | %7s %7s\n", "class", "count", "tip",
              "scenes", "sure", "recog", "wrong", "err/dev", "ms p50", "max");
  RecognizerOptions options;
  options.touched_from = TouchedFrom::Outside;
  for (const int count : counts) {
    for (const double tip : {0.0, 0.05}) {
      for (const CurveClass curve_class : kCurveClasses) {
        if (!curve.empty() && curve != name_of(curve_class)) continue;
        Cell cell;
        for (int i = 0; i < scenes; ++i) {
          std::mt19937_64 rng;
          const LoneTouches touches = scene_of(seed, curve_class, count, i, noise, tip, &rng);
          Recognizer recognizer(options);
          const double sigma_m = unstated ? 0.0 : touches.scene.sigma_m;
          if (normals_deg > 0.0) {
            test::add_touches_with_normals(touches, sigma_m, normals_deg * kPi / 180.0, rng,
                                           &recognizer);
          } else {
            test::add_touches(touches, sigma_m, &recognizer);
          }
          const double begin_us = bench::thread_us();
          const Recognition answer = recognizer.recognize();
          cell.ms.push_back(1e-3 * (bench::thread_us() - begin_us));
          ++cell.scenes;
          const Hypothesis* own = test::hypothesis_of(answer, curve_class);
          cell.sure += own != nullptr && own->probability >= 0.95 ? 1 : 0;
          if (answer.status != RecognitionStatus::Recognized) continue;
          ++cell.recognized;
          if (answer.shape.curve_class != curve_class) {
            ++cell.wrong;
            ++cell.by_wrong[std::string(name_of(answer.shape.curve_class))];
            continue;
          }
          const Eigen::VectorXd error = test::error_of(answer.hypotheses.front(), touches.scene);
          const auto letters = static_cast<Eigen::Index>(parameter_letters(curve_class).size());
          for (Eigen::Index k = 0; k < letters; ++k) {
            cell.squares += error[k] * error[k] / answer.covariance(k, k);
            ++cell.letters;
          }
        }
        std::sort(cell.ms.begin(), cell.ms.end());
        std::printf("%-22s %5d %4.2f | %6d %5d %5d %5d | %9.2f | %7.2f %7.2f",
                    std::string(name_of(curve_class)).c_str(), count, tip, cell.scenes, cell.sure,
                    cell.recognized, cell.wrong,
                    cell.letters > 0 ? std::sqrt(cell.squares / cell.letters) : 0.0,
                    cell.ms[cell.ms.size() / 2], cell.ms.back());
        for (const auto& [wrong, times] : cell.by_wrong) {
          std::printf("  %s %d", wrong.c_str(), times);
        }
        std::printf("\n");
      }
    }
  }
  return 0;
}
