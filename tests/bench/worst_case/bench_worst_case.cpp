// Searches for the input whose recognize() costs most compared with a clean ellipse of as many
// samples and patches. It uses random restarts and local changes over any shape or none, noise,
// tips, patches and spikes. Prints the worst input found, writes it as a CSV file, and says how to
// count its instructions. Or it measures given CSV files.
//   bench_worst_case [--seconds S] [--tries N] [--seed S] [--most-samples N] [--kind KIND]
//                    [--save FILE]
//   bench_worst_case FILE.csv ...        costs of these files
//   bench_worst_case --once FILE.csv     only one recognize() of the file, for callgrind
// Costs are processor times of this thread, the least of some runs, an input's and its ellipse's in
// turn: a busy machine, or one whose clock changes, matters little.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/recognition/samples/work_limit.h"
#include "node/csv/contact_csv.h"
#include "tests/bench/options/bench_options.h"
#include "tests/bench/options/thread_time.h"
#include "tests/bench/worst_case/csv_input.h"
#include "tests/bench/worst_case/touched_input.h"
#include "tests/bench/worst_case/work_prices.h"

namespace {

using namespace palpate;
using bench::input_from;
using bench::InputRecipe;
using bench::thread_us;
using bench::TouchedInput;

constexpr int kTurns = 5;  // of an input and its ellipse
/// A climb starts at the worst of this many random inputs, and ends after this many changes in a
/// row without a worse result.
constexpr int kStarts = 12;
constexpr int kPatience = 20;
/// Share of new starts from the worst input found so far; the others are random.
constexpr double kFromWorst = 0.3;

struct Cost {
  double us = 0.0;
  WorkBudget work;

  /// Counted work over what may be counted.
  double share() const { return work.spent() / work.most(); }
};

Cost cost_once(const TouchedInput& input) {
  Recognizer recognizer;
  for (const bench::TouchedPatch& patch : input) {
    recognizer.add(patch.context, patch.samples);
  }
  const double start = thread_us();
  const Recognition answer = recognizer.recognize();
  const double us = thread_us() - start;
  return {answer.sample_count > 0 ? us : 0.0, answer.work};
}

/// An input's cost and that of its clean ellipse, measured in turn.
struct SideBySide {
  Cost input;
  Cost ellipse;

  double ratio() const { return ellipse.us > 0.0 ? input.us / ellipse.us : 0.0; }
};

SideBySide side_by_side(const TouchedInput& input, int turns = kTurns) {
  const TouchedInput ellipse = bench::clean_ellipse_like(input);
  SideBySide least{cost_once(input), cost_once(ellipse)};
  for (int i = 1; i < turns; ++i) {
    least.input.us = std::min(least.input.us, cost_once(input).us);
    least.ellipse.us = std::min(least.ellipse.us, cost_once(ellipse).us);
  }
  return least;
}

struct Found {
  InputRecipe recipe;
  SideBySide cost;
};

/// The cost; nullopt if it is not above `ratio`, as a first measurement mostly shows.
std::optional<Found> measured(const InputRecipe& recipe, double ratio) {
  const TouchedInput input = bench::input_of(recipe);
  if (side_by_side(input, 1).ratio() <= ratio) return std::nullopt;
  const SideBySide cost = side_by_side(input);
  return cost.ratio() > ratio ? std::optional(Found{recipe, cost}) : std::nullopt;
}

ContactTable table_of(const TouchedInput& input) {
  ContactTable table;
  table.names = {"probe", "worst"};
  for (const bench::TouchedPatch& patch : input) {
    for (const ContactSample& sample : patch.samples) {
      table.rows.push_back({0, 1, 0, patch.context, sample});
    }
  }
  return table;
}

int run_files(const std::vector<std::string>& files) {
  std::printf("%-40s %8s %8s %12s %12s %8s %12s %12s\n", "file", "patches", "samples", "us",
              "ellipse us", "ratio", "work, share", "ellipse's");
  for (const std::string& file : files) {
    const auto input = input_from(file);
    if (!input) return 2;
    const auto [cost, clean] = side_by_side(*input);
    std::printf("%-40s %8zu %8zu %12.0f %12.0f %8.1f %12.3f %12.3f\n", file.c_str(), input->size(),
                bench::sample_count(*input), cost.us, clean.us, cost.us / clean.us, cost.share(),
                clean.share());
    std::fflush(stdout);
  }
  return 0;
}

/// Random inputs of the kind, each beside its clean ellipse.
int measure_prices(int tries, std::uint64_t seed, bench::InputKind kind, int most_samples) {
  std::mt19937_64 rng(seed);
  std::vector<bench::CountedTime> measured;
  for (int i = 0; i < tries; ++i) {
    const TouchedInput input = bench::input_of(bench::random_recipe(rng, kind, most_samples));
    const auto [own, ellipse] = side_by_side(input);
    for (const Cost& cost : {own, ellipse}) {
      if (cost.us > 0.0) measured.push_back({cost.us, cost.work.counts()});
    }
  }
  bench::print_prices(measured);
  return 0;
}

/// The counted work of an input whose noise is ten times longer one way, and stated so.
double work_with_covariances(TouchedInput input, std::uint32_t seed) {
  constexpr double kLonger = 10.0;
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> normal;
  Recognizer recognizer;
  for (bench::TouchedPatch& patch : input) {
    std::vector<SampleDetail> details;
    for (ContactSample& sample : patch.samples) {
      const double variance_m2 = sample.sigma_m * sample.sigma_m;
      sample.position_m.x() += std::sqrt(kLonger * kLonger - 1.0) * sample.sigma_m * normal(rng);
      details.emplace_back().covariance_m2 =
          variance_m2 * Eigen::Vector3d(kLonger * kLonger, 0.0, 1.0);
      sample.sigma_m = mean_sigma_m(details.back().covariance_m2);
    }
    recognizer.add(patch.context, patch.samples, details);
  }
  return recognizer.recognize().work.spent();
}

/// The counted work of clean ellipses, the middle one of some, beside what work_limit.h says, and
/// beside that of ellipses whose samples state covariances.
int measure_ellipses() {
  constexpr std::array kPatches = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64};
  constexpr std::array kSamples = {1, 8, 16, 32, 64, 128, 256, 512, 1024};  // of a patch
  constexpr std::uint32_t kSeeds = 9;
  std::printf("%8s %8s %12s %12s %8s %12s %8s\n", "patches", "samples", "work", "work_limit.h",
              "ratio", "covariances", "ratio");
  for (const int patches : kPatches) {
    for (const int samples : kSamples) {
      const std::vector<ContactSample> any(static_cast<std::size_t>(samples));
      const TouchedInput like(static_cast<std::size_t>(patches), {{}, any});
      std::array<double, kSeeds> work{};
      std::array<double, kSeeds> of_covariances{};
      for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
        const TouchedInput ellipse = bench::clean_ellipse_like(like, seed + 1);
        work.at(seed) = cost_once(ellipse).work.spent();
        of_covariances.at(seed) = work_with_covariances(ellipse, seed + 1);
      }
      std::sort(work.begin(), work.end());
      std::sort(of_covariances.begin(), of_covariances.end());
      const double told = work_of_clean_ellipse(bench::sample_count(like), like.size());
      std::printf("%8d %8d %12.0f %12.0f %8.2f %12.0f %8.2f\n", patches, samples * patches,
                  work[kSeeds / 2], told, work[kSeeds / 2] / told, of_covariances[kSeeds / 2],
                  of_covariances[kSeeds / 2] / work[kSeeds / 2]);
      std::fflush(stdout);
    }
  }
  return 0;
}

struct Options {
  bool prices = false;
  bool ellipses = false;
  double seconds = 60.0;
  int tries = std::numeric_limits<int>::max();
  std::uint64_t seed = 1;
  int most_samples = 2000;
  std::string kind = "any";
  std::string save = "worst_case.csv";
};

int search(const Options& options, bench::InputKind kind, const std::string& program) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  std::mt19937_64 rng(options.seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Found worst;
  Found current;
  int starts = 0;  // of this climb
  int idle = 0;    // changes in a row
  long tries = 0;
  std::vector<double> ratios_of_starts;
  for (; tries < options.tries && elapsed() < options.seconds; ++tries) {
    if (idle >= kPatience) {
      const bool again = uniform(rng) < kFromWorst;
      current = again ? worst : Found{};
      starts = again ? kStarts : 0;
      idle = 0;
    }
    const bool climbs = starts >= kStarts;
    const InputRecipe recipe = climbs
                                   ? bench::mutated(current.recipe, rng, kind, options.most_samples)
                                   : bench::random_recipe(rng, kind, options.most_samples);
    starts += climbs ? 0 : 1;
    const auto found = measured(recipe, climbs ? current.cost.ratio() : 0.0);
    if (!climbs && found) ratios_of_starts.push_back(found->cost.ratio());
    if (!found || found->cost.ratio() <= current.cost.ratio()) {
      idle += climbs ? 1 : 0;
      continue;
    }
    idle = 0;
    current = *found;
    if (current.cost.ratio() > worst.cost.ratio()) {
      worst = current;
      std::printf("try %ld, %.0f s: ratio %.1f, %.0f us, work %.2f of its limit: %s\n", tries,
                  elapsed(), worst.cost.ratio(), worst.cost.input.us, worst.cost.input.share(),
                  bench::to_text(worst.recipe).c_str());
      std::fflush(stdout);
    }
  }
  if (worst.cost.ratio() == 0.0) {
    std::printf("no input in %ld tries\n", tries);
    return 1;
  }
  std::ofstream file(options.save);
  const TouchedInput input = bench::input_of(worst.recipe);
  file << to_csv(table_of(input));
  file.close();
  if (!file) {
    std::fprintf(stderr, "bench_worst_case: %s cannot be written\n", options.save.c_str());
    return 1;
  }
  std::sort(ratios_of_starts.begin(), ratios_of_starts.end());
  std::printf(
      "\n%ld tries, %zu random starts (median ratio %.1f, highest %.1f)\n"
      "worst: %.1f times a clean ellipse of as many samples and patches (%.0f us beside %.0f us), "
      "work %.2f "
      "of its limit\n "
      " %s\nin %s; its instructions:\n"
      "  valgrind --tool=callgrind --toggle-collect='palpate::Recognizer::recognize()' %s --once "
      "%s\n",
      tries, ratios_of_starts.size(),
      ratios_of_starts.empty() ? 0.0 : ratios_of_starts[ratios_of_starts.size() / 2],
      ratios_of_starts.empty() ? 0.0 : ratios_of_starts.back(), worst.cost.ratio(),
      worst.cost.input.us, worst.cost.ellipse.us, worst.cost.input.share(),
      bench::to_text(worst.recipe).c_str(), options.save.c_str(), program.c_str(),
      options.save.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  std::vector<std::string> files;
  std::string once;
  if (const auto end =
          bench::BenchOptions("The worst case of recognize(), searched for, or of given files")
              .files(files, "CSV files to measure instead of searching")
              .text("--once", once, "One recognize() of this CSV file and nothing else")
              .flag("--prices", options.prices,
                    "What each kind of counted work costs, over random inputs")
              .flag("--ellipses", options.ellipses,
                    "Counted work of clean ellipses beside what the limit takes it to be")
              .number("--seconds", options.seconds, "End of the search")
              .number("--tries", options.tries, "Most inputs that are tried")
              .seed(options.seed)
              .number("--most-samples", options.most_samples, "Most samples of an input")
              .text("--kind", options.kind,
                    "Of input: any, plain, tips, sides, spikes, unstated, few or patches")
              .text("--save", options.save, "Where the worst input goes")
              .parse(argc, argv)) {
    return *end;
  }
  if (!once.empty()) {
    const auto input = input_from(once);
    if (!input) return 2;
    std::printf("%.0f us\n", cost_once(*input).us);
    return 0;
  }
  const auto kind = bench::input_kind(options.kind);
  if (!kind) {
    std::fprintf(stderr, "bench_worst_case: no kind is called %s\n", options.kind.c_str());
    return 2;
  }
  if (options.prices) {
    constexpr int kTries = 500;
    return measure_prices(std::min(options.tries, kTries), options.seed, *kind,
                          options.most_samples);
  }
  if (options.ellipses) return measure_ellipses();
  return files.empty() ? search(options, *kind, argv[0]) : run_files(files);
}
