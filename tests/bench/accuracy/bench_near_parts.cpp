// What is said of parts that are of a class but for a little, by how much the samples show it.
// Prints, of each part, how many are RECOGNIZED as a class, as none, and not at all.
//   bench_near_parts [--scenes N] [--seed S]
#include <array>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>

#include "tests/bench/options/bench_options.h"
#include "tests/support/near_parts.h"
#include "tests/support/scene_data.h"

namespace {

using namespace palpate;

/// Chi-squares that the best class leaves of the exact places: of 200 samples, a twentieth to ten
/// standard deviations of what noise leaves.
constexpr std::array kMisfits = {1.0, 9.0, 25.0, 49.0, 100.0, 200.0};

struct Said {
  int of_a_class = 0;
  int of_none = 0;
  int unsure = 0;
};

Said said_of(const test::NearPart& part, double misfit, int scenes, std::mt19937_64& rng) {
  const double sigma_m = test::noise_of_misfit(part, misfit);
  std::normal_distribution<double> normal;
  Said said;
  for (int i = 0; i < scenes; ++i) {
    const test::Scene scene = test::touched(part, sigma_m, [&] { return normal(rng); });
    const Recognition answer = test::recognise(scene, sigma_m);
    const bool none = answer.shape.curve_class == CurveClass::Unclassified;
    ++(answer.status != RecognitionStatus::Recognized ? said.unsure
       : none                                         ? said.of_none
                                                      : said.of_a_class);
  }
  return said;
}

}  // namespace

int main(int argc, char** argv) {
  int scenes = 40;
  std::uint64_t seed = 2026;
  if (const auto end = bench::BenchOptions("What is said of parts that are nearly of a class")
                           .number("--scenes", scenes, "Recordings of a part and misfit")
                           .seed(seed)
                           .parse(argc, argv)) {
    return *end;
  }
  std::mt19937_64 rng(seed);
  std::printf("RECOGNIZED as a class / as none / not RECOGNIZED, of %d each\n%-16s", scenes,
              "misfit");
  for (const double misfit : kMisfits) std::printf("%14.0f", misfit);
  std::printf("\n");
  for (const test::NearPart& part : test::near_parts()) {
    std::printf("%-16s", part.name.c_str());
    for (const double misfit : kMisfits) {
      const Said said = said_of(part, misfit, scenes, rng);
      std::printf("  %4d%4d%4d", said.of_a_class, said.of_none, said.unsure);
    }
    std::printf("\n");
  }
  return 0;
}
