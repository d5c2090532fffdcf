// Measures what hard decisions about spikes cost: the error of an answer that removes samples,
// compared with one that knows which samples are spikes. (The exact likelihood would be a mixture.)
// Prints a table by share of spikes, with noise stated and not stated.
//   bench_spikes [--scenes N] [--seed S]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "core/curves/curve.h"
#include "core/local/spikes/spikes.h"
#include "tests/bench/options/bench_options.h"
#include "tests/support/joint_error.h"
#include "tests/support/scene_data.h"
#include "tests/support/scene_prior.h"

namespace {

using namespace palpate;

constexpr std::array kShares = {0.0, 0.02, 0.1, 0.3};
/// Maximum displacement of each coordinate of a spike, relative to the size, in either direction.
constexpr double kReach = 0.1;
/// A sample farther from the curve than this many standard deviations is not noise.
constexpr double kFarOff = 5.0;

struct Spiked {
  test::Scene scene;
  test::Scene without;  ///< with the good samples only
  std::vector<std::vector<bool>> is_spike;
};

Spiked spiked(const test::PriorScene& drawn, double share, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Spiked result{drawn.scene, drawn.scene, {}};
  for (std::size_t p = 0; p < drawn.scene.patches.size(); ++p) {
    std::vector<bool> flags;
    result.without.patches[p].clear();
    for (Vec2& sample : result.scene.patches[p]) {
      const bool spike = unit(rng) < share;
      flags.push_back(spike);
      if (spike) {
        const double dx = 2.0 * unit(rng) - 1.0;
        sample += kReach * drawn.size_m * Vec2(dx, 2.0 * unit(rng) - 1.0);
      } else {
        result.without.patches[p].push_back(sample);
      }
    }
    result.is_spike.push_back(std::move(flags));
  }
  return result;
}

double of_truth(const Recognition& answer, CurveClass truth) {
  const Hypothesis* found = test::hypothesis_of(answer, truth);
  return found != nullptr ? found->probability : 0.0;
}

bool is_right(const Recognition& answer, CurveClass truth) {
  return answer.status == RecognitionStatus::Recognized && answer.shape.curve_class == truth;
}

struct Counts {
  long far_off = 0;  ///< spikes
  long left = 0;     ///< of these, spikes remaining after the search without a class
  long lost = 0;     ///< good samples lost by that search
  long scenes = 0;
  long right_told = 0;
  long right = 0;
  long wrong_told = 0;
  long wrong = 0;
  double squares = 0.0;  ///< of the difference of the estimates, in units of their covariance
  long components = 0;
  std::vector<double> differences;  ///< of the true class's probability

  void count_search(const Spiked& spiked, const Curve& curve, double stated_m) {
    for (std::size_t p = 0; p < spiked.scene.patches.size(); ++p) {
      const std::vector<Vec2>& samples = spiked.scene.patches[p];
      std::vector<bool> found(samples.size(), false);
      for (const std::size_t i : find_spikes(samples, {.sigma_m = stated_m}).indices) {
        found[i] = true;
      }
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const Vec2 local = spiked.scene.world_T_curve.to_local(samples[i]);
        const bool far =
            std::abs(foot_point(curve, local).distance) > kFarOff * spiked.scene.sigma_m;
        const bool spike = spiked.is_spike[p][i] && far;
        far_off += spike ? 1 : 0;
        left += spike && !found[i] ? 1 : 0;
        lost += !spiked.is_spike[p][i] && found[i] ? 1 : 0;
      }
    }
  }

  void count_answers(const Spiked& spiked, const Recognition& told, const Recognition& answer) {
    const CurveClass truth = spiked.scene.curve_class;
    ++scenes;
    right_told += is_right(told, truth) ? 1 : 0;
    right += is_right(answer, truth) ? 1 : 0;
    wrong_told += told.status == RecognitionStatus::Recognized && !is_right(told, truth) ? 1 : 0;
    wrong += answer.status == RecognitionStatus::Recognized && !is_right(answer, truth) ? 1 : 0;
    differences.push_back(std::abs(of_truth(answer, truth) - of_truth(told, truth)));
    if (is_right(told, truth) && is_right(answer, truth)) {
      test::Scene with_inferred_chi2 = spiked.scene;
      with_inferred_chi2.values = told.shape.values;
      with_inferred_chi2.world_T_curve = told.world_T_curve;
      const test::JointError error =
          test::joint_error(answer.hypotheses.front(), with_inferred_chi2);
      squares += test::squared_distance(error);
      components += error.error.size();
    }
  }
};

double at(std::vector<double> values, double fraction) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1))];
}

}  // namespace

int main(int argc, char** argv) {
  int scenes = 400;
  std::uint64_t seed = 2026;
  if (const auto end = bench::BenchOptions("What hard decisions about spikes cost an answer")
                           .number("--scenes", scenes, "Scenes of a row")
                           .seed(seed)
                           .parse(argc, argv)) {
    return *end;
  }
  std::printf(
      "Spikes reach %g sizes; those more than %g deviations off the curve. The answer beside one "
      "that is told which they are:\nRECOGNIZED and right or wrong, told / not; |P(truth) - "
      "P(truth) "
      "told|; rms of the estimates' difference in published deviations\n",
      kReach, kFarOff);
  std::printf("%-8s %6s %9s %7s %7s | %-13s %-9s | %8s %8s | %6s\n", "noise", "share", "spikes",
              "left", "lost", "right", "wrong", "dP 90 %", "dP 99 %", "rms");
  for (const bool stated : {true, false}) {
    for (const double share : kShares) {
      Counts counts;
      for (int i = 0; i < scenes; ++i) {
        const test::PriorScene drawn = test::scene_from(test::classes_only(test::even_prior()),
                                                        seed, static_cast<std::uint32_t>(i));
        std::mt19937_64 rng(seed + static_cast<std::uint64_t>(i));
        const Spiked with = spiked(drawn, share, rng);
        const auto curve = make_curve(with.scene.curve_class, with.scene.values);
        const double sigma_m = stated ? with.scene.sigma_m : 0.0;
        if (curve) counts.count_search(with, *curve, sigma_m);
        counts.count_answers(with, test::recognise(with.without, sigma_m),
                             test::recognise(with.scene, sigma_m));
      }
      std::printf(
          "%-8s %5.0f %% %9ld %7ld %7ld | %5ld / %-5ld %3ld / %-3ld | %8.4f %8.4f | %6.3f\n",
          stated ? "stated" : "unknown", 100.0 * share, counts.far_off, counts.left, counts.lost,
          counts.right_told, counts.right, counts.wrong_told, counts.wrong,
          at(counts.differences, 0.9), at(counts.differences, 0.99),
          std::sqrt(counts.squares / static_cast<double>(std::max(counts.components, 1L))));
      std::fflush(stdout);
    }
  }
  return 0;
}
