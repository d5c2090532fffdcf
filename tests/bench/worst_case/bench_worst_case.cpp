// Searches for the input whose recognize() costs most compared with a clean ellipse of as many
// samples and patches. It uses random restarts and local changes over any shape or none, noise,
// tips, patches and spikes. Prints the worst input found, writes it as a CSV file, and says how to
// count its instructions. Or it measures given CSV files.
//   bench_worst_case [--seconds S] [--tries N] [--seed S] [--most-samples N] [--kind KIND]
//                    [--save FILE]
//   bench_worst_case FILE.csv ...        costs of these files
//   bench_worst_case --once FILE.csv     only one recognize() of the file, for callgrind
// Costs are processor times of this thread, the least of three runs, so that a busy machine matters
// little.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "node/csv/contact_csv.h"
#include "tests/bench/options/bench_options.h"
#include "tests/bench/options/thread_time.h"
#include "tests/bench/worst_case/touched_input.h"

namespace {

using namespace palpate;
using bench::InputRecipe;
using bench::thread_us;
using bench::TouchedInput;

constexpr int kRepetitions = 3;
/// A climb starts at the worst of this many random inputs, and ends after this many changes in a
/// row without a worse result.
constexpr int kStarts = 12;
constexpr int kPatience = 20;
/// Share of new starts from the worst input found so far; the others are random.
constexpr double kFromWorst = 0.3;

double cost_once_us(const TouchedInput& input) {
  Recognizer recognizer;
  for (const bench::TouchedPatch& patch : input) {
    recognizer.add(patch.context, patch.samples);
  }
  const double start = thread_us();
  const Recognition answer = recognizer.recognize();
  const double us = thread_us() - start;
  return answer.sample_count > 0 ? us : 0.0;
}

double cost_us(const TouchedInput& input) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kRepetitions; ++i) {
    least = std::min(least, cost_once_us(input));
  }
  return least;
}

/// Cost of the clean ellipse with that many samples in each of that many patches; each is measured
/// once.
double clean_cost_us(const TouchedInput& input) {
  static std::map<std::vector<std::size_t>, double> known;
  std::vector<std::size_t> sizes;
  for (const bench::TouchedPatch& patch : input) sizes.push_back(patch.samples.size());
  const auto [found, is_new] = known.try_emplace(sizes, 0.0);
  if (is_new) found->second = cost_us(bench::clean_ellipse_like(input));
  return found->second;
}

struct Found {
  InputRecipe recipe;
  double us = 0.0;
  double ratio = 0.0;
};

/// The cost; nullopt if a first measurement shows that it is not above `ratio`.
std::optional<Found> measured(const InputRecipe& recipe, double ratio) {
  const TouchedInput input = bench::input_of(recipe);
  const double clean = clean_cost_us(input);
  const double once = cost_once_us(input);
  if (once <= ratio * clean) return std::nullopt;
  const double us = std::min({once, cost_once_us(input), cost_once_us(input)});
  if (us <= ratio * clean) return std::nullopt;
  return Found{recipe, us, us / clean};
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

std::optional<TouchedInput> input_from(const std::string& path) {
  const Result<ContactTable> table = read_contact_csv(path);
  if (!table) {
    std::fprintf(stderr, "bench_worst_case: %s\n", table.error.c_str());
    return std::nullopt;
  }
  // In the order of the file, as the tool does; all groups and objects of a file are one here.
  TouchedInput input;
  std::map<std::tuple<std::size_t, std::size_t, std::uint64_t, std::uint32_t>, std::size_t> places;
  for (const ContactRow& row : table.value->rows) {
    const auto [place, is_new] =
        places.try_emplace({row.group, row.probe, row.object, row.context.patch}, input.size());
    if (is_new) {
      PatchContext context = row.context;
      context.patch = static_cast<std::uint32_t>(input.size());
      input.push_back({context, {}});
    }
    input[place->second].samples.push_back(row.sample);
  }
  return input;
}

int run_files(const std::vector<std::string>& files) {
  std::printf("%-40s %8s %8s %12s %12s %8s\n", "file", "patches", "samples", "us", "ellipse us",
              "ratio");
  for (const std::string& file : files) {
    const auto input = input_from(file);
    if (!input) return 2;
    const double us = cost_us(*input);
    const double clean = clean_cost_us(*input);
    std::printf("%-40s %8zu %8zu %12.0f %12.0f %8.1f\n", file.c_str(), input->size(),
                bench::sample_count(*input), us, clean, us / clean);
    std::fflush(stdout);
  }
  return 0;
}

struct Options {
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
    const auto found = measured(recipe, climbs ? current.ratio : 0.0);
    if (!climbs && found) ratios_of_starts.push_back(found->ratio);
    if (!found || found->ratio <= current.ratio) {
      idle += climbs ? 1 : 0;
      continue;
    }
    idle = 0;
    current = *found;
    if (current.ratio > worst.ratio) {
      worst = current;
      std::printf("try %ld, %.0f s: ratio %.1f, %.0f us: %s\n", tries, elapsed(), worst.ratio,
                  worst.us, bench::to_text(worst.recipe).c_str());
      std::fflush(stdout);
    }
  }
  if (worst.ratio == 0.0) {
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
      "worst: %.1f times a clean ellipse of as many samples and patches (%.0f us beside %.0f us)\n "
      " %s\nin %s; its instructions:\n"
      "  valgrind --tool=callgrind --toggle-collect='palpate::Recognizer::recognize()' %s --once "
      "%s\n",
      tries, ratios_of_starts.size(),
      ratios_of_starts.empty() ? 0.0 : ratios_of_starts[ratios_of_starts.size() / 2],
      ratios_of_starts.empty() ? 0.0 : ratios_of_starts.back(), worst.ratio, worst.us,
      clean_cost_us(input), bench::to_text(worst.recipe).c_str(), options.save.c_str(),
      program.c_str(), options.save.c_str());
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
    std::printf("%.0f us\n", cost_once_us(*input));
    return 0;
  }
  const auto kind = bench::input_kind(options.kind);
  if (!kind) {
    std::fprintf(stderr, "bench_worst_case: no kind is called %s\n", options.kind.c_str());
    return 2;
  }
  return files.empty() ? search(options, *kind, argv[0]) : run_files(files);
}
