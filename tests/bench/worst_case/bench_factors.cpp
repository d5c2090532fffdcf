// By what factor one condition increases the cost of recognize(), over random scenes that are
// otherwise the same: tips whose side is not stated, spikes in 30 % of the samples, or both. Also
// the cost of a stream's updates compared with their median, and how many of the dearest ones began
// a patch, so that all curves were sought anew.
//   bench_factors [--scenes N] [--seed S]
// Costs are processor times of this thread, the least of three runs.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "tests/bench/options/bench_options.h"
#include "tests/bench/options/thread_time.h"
#include "tests/bench/worst_case/plain_recipe.h"
#include "tests/bench/worst_case/touched_input.h"

namespace {

using namespace palpate;
using bench::InputRecipe;
using bench::thread_us;
using bench::TouchedInput;

constexpr int kRepetitions = 3;
constexpr std::size_t kSamplesPerUpdate = 10;

double recognize_us(Recognizer& recognizer) {
  const double start = thread_us();
  recognizer.recognize();
  return thread_us() - start;
}

double cost_us(const TouchedInput& input) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kRepetitions; ++i) {
    Recognizer recognizer;
    for (const bench::TouchedPatch& patch : input) {
      recognizer.add(patch.context, patch.samples);
    }
    least = std::min(least, recognize_us(recognizer));
  }
  return least;
}

void print(const std::string& what, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double fraction) {
    return values[static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1))];
  };
  std::printf("%-44s %8zu %8.2f %8.2f %8.2f %8.2f\n", what.c_str(), values.size(), at(0.5), at(0.9),
              at(0.99), at(1.0));
}

struct Update {
  double cost = 0.0;  ///< [us], or over the median of its stream
  bool begins_patch = false;
};

/// The updates of one stream.
std::vector<Update> updates_of(const TouchedInput& input) {
  Recognizer recognizer;
  std::vector<Update> updates;
  for (const bench::TouchedPatch& patch : input) {
    for (std::size_t begin = 0; begin < patch.samples.size(); begin += kSamplesPerUpdate) {
      const std::size_t count = std::min(kSamplesPerUpdate, patch.samples.size() - begin);
      recognizer.add(patch.context, std::span(patch.samples).subspan(begin, count));
      updates.push_back({recognize_us(recognizer), begin == 0});
    }
  }
  return updates;
}

/// The same with their costs divided by the median.
std::vector<Update> updates_over_median(const TouchedInput& input) {
  std::vector<Update> least = updates_of(input);
  for (int i = 1; i < kRepetitions; ++i) {
    const std::vector<Update> again = updates_of(input);
    for (std::size_t k = 0; k < least.size(); ++k) {
      least[k].cost = std::min(least[k].cost, again[k].cost);
    }
  }
  std::vector<Update> sorted = least;
  std::ranges::sort(sorted, {}, &Update::cost);
  const double median = sorted[sorted.size() / 2].cost;
  for (Update& update : least) {
    update.cost /= median;
  }
  return least;
}

void print_dearest(const std::vector<Update>& updates) {
  constexpr double kDear = 8.0;
  const auto is_dear = [](const Update& update) { return update.cost > kDear; };
  std::printf("updates above %.0f times: %td of %zu, %td of which began a patch\n", kDear,
              std::ranges::count_if(updates, is_dear), updates.size(),
              std::ranges::count_if(updates, [&](const Update& update) {
                return is_dear(update) && update.begins_patch;
              }));
}

}  // namespace

int main(int argc, char** argv) {
  int scenes = 300;
  std::uint64_t seed = 1;
  if (const auto end = bench::BenchOptions("What makes recognize() dearer, and by how much")
                           .number("--scenes", scenes, "Number of scenes")
                           .seed(seed)
                           .parse(argc, argv)) {
    return *end;
  }
  std::mt19937_64 rng(seed);
  std::vector<double> plain, sides, spikes, both, costs;
  std::vector<Update> updates;
  for (int i = 0; i < scenes; ++i) {
    InputRecipe recipe = bench::plain_recipe(rng);
    recipe.tip = 0.1;
    const TouchedInput input = bench::input_of(recipe);
    const double us = cost_us(input);
    plain.push_back(us);
    const auto factor = [&](double sides_told, double share) {
      InputRecipe other = recipe;
      other.sides_told = sides_told;
      other.spikes = share;
      return cost_us(bench::input_of(other)) / us;
    };
    sides.push_back(factor(0.0, 0.0));
    spikes.push_back(factor(1.0, 0.3));
    both.push_back(factor(0.0, 0.3));
    for (const Update& update : updates_over_median(input)) {
      updates.push_back(update);
      costs.push_back(update.cost);
    }
  }
  std::printf("%-44s %8s %8s %8s %8s %8s\n", "", "values", "median", "90 %", "99 %", "maximum");
  print("us, tips whose side is told", plain);
  print("factor of sides not told", sides);
  print("factor of spikes in 30 % of the samples", spikes);
  print("factor of both", both);
  print("updates of a stream over its median", costs);
  print_dearest(updates);
  return 0;
}
