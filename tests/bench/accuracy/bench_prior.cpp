// Whether probabilities are true where the parts are drawn from the very prior that is assumed
// (tests/support/assumed_prior.h): what is left there is the integrals' own error. Prints, by bin
// of the stated probability, how often the answer is right; and the stated mass of every class
// beside how often it is the truth, in deviations of that number (the sum of Bernoulli variances).
//   bench_prior [--scenes N] [--seed S] [--noise stated|unknown]
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

#include "core/recognition/recognizer.h"
#include "tests/bench/accuracy/calibration_table.h"
#include "tests/bench/options/bench_options.h"
#include "tests/support/assumed_prior.h"
#include "tests/support/calibration.h"

namespace {

using namespace palpate;

Recognition recognised(const test::AssumedScene& scene, bool sigma_known) {
  std::vector<ContactSample> samples = scene.samples;
  for (ContactSample& sample : samples) {
    sample.sigma_m = sigma_known ? scene.sigma_m : 0.0;
  }
  Recognizer recognizer;
  recognizer.add({}, samples);
  return recognizer.recognize();
}

/// From here on an answer that is wrong is listed.
constexpr double kSure = 0.99;

void print_wrong(int number, const test::AssumedScene& scene, const Recognition& answer) {
  std::printf("scene %d, sigma/half extent %.1e:", number, scene.sigma);
  for (const Hypothesis& hypothesis : answer.hypotheses) {
    if (hypothesis.shape.curve_class == scene.truth || &hypothesis == &answer.hypotheses.front()) {
      std::printf(" %s%s P %.2g, chi-square %.1f;",
                  std::string(name_of(hypothesis.shape.curve_class)).c_str(),
                  hypothesis.shape.curve_class == scene.truth ? " (the truth)" : "",
                  hypothesis.probability, hypothesis.chi2);
    }
  }
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  int scenes = 2000;
  std::uint64_t seed = 2026;
  std::string noise = "stated";
  if (const auto end =
          bench::BenchOptions("Probabilities beside the truth, of parts from the assumed prior")
              .number("--scenes", scenes, "Number of scenes")
              .one_of({"stated", "unknown"}, "--noise", noise,
                      "Whether the samples state their noise")
              .seed(seed)
              .parse(argc, argv)) {
    return *end;
  }
  test::Calibration pooled;
  std::array<test::Calibration, 9> by_class;
  std::array<double, 9> stated{};
  std::array<double, 9> variance{};
  std::array<int, 9> true_count{};
  for (int i = 0; i < scenes; ++i) {
    const test::AssumedScene scene = test::draw_assumed(seed, static_cast<std::uint32_t>(i));
    const CurveClass truth = scene.truth;
    const Recognition answer = recognised(scene, noise == "stated");
    ++true_count[static_cast<std::size_t>(truth)];
    for (const Hypothesis& hypothesis : answer.hypotheses) {
      const auto k = static_cast<std::size_t>(hypothesis.shape.curve_class);
      stated[k] += hypothesis.probability;
      variance[k] += hypothesis.probability * (1.0 - hypothesis.probability);
    }
    if (!answer.hypotheses.empty()) {
      const double probability = answer.hypotheses.front().probability;
      const CurveClass named = answer.shape.curve_class;
      pooled.add(probability, named == truth);
      by_class[static_cast<std::size_t>(named)].add(probability, named == truth);
      if (probability >= kSure && named != truth) print_wrong(i, scene, answer);
    }
  }
  std::printf("%d scenes, seed %llu\n%-24s %-11s %7s %9s %9s   %s\n", scenes,
              static_cast<unsigned long long>(seed), "answer", "bin", "scenes", "stated",
              "observed", "99.9 % band");
  int beside = bench::print_calibration("all", pooled);
  for (std::size_t i = 0; i < by_class.size(); ++i) {
    beside +=
        bench::print_calibration(std::string(name_of(static_cast<CurveClass>(i))), by_class[i]);
  }
  std::printf("bins beside their band: %d\n\n%-24s %12s %6s %11s\n", beside, "class", "stated mass",
              "truth", "deviations");
  for (std::size_t i = 0; i < stated.size(); ++i) {
    std::printf("%-24s %12.1f %6d %11.1f\n",
                std::string(name_of(static_cast<CurveClass>(i))).c_str(), stated[i], true_count[i],
                (stated[i] - true_count[i]) / std::sqrt(variance[i]));
  }
  return 0;
}
