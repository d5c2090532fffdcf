// The recognizer's options, in one table for the node and the tools.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/recognition/recognizer.h"

namespace palpate {

/// One option. Its name is the field in NodeConfig, the flag (--max-groups) and the environment
/// variable (PALPATE_MAX_GROUPS).
struct OptionInfo {
  const char* name;
  const char* help;
  double lowest = 0.0;  ///< for numbers only
  double highest = std::numeric_limits<double>::max();
  const char* also = "";  ///< a second, shorter flag; it has an environment variable too
};

/// Whether an option is a flag that --no-... takes back. One that is optional has a default that
/// depends on others.
template <typename Field>
inline constexpr bool is_switch =
    std::is_same_v<Field, bool> || std::is_same_v<Field, std::optional<bool>>;

/// Converts "sigma_m" to "--sigma-m".
std::string flag_of(std::string name);

/// The flags of an option in CLI11's form, e.g. "--sigma,--sigma-m".
std::string flags_of(const OptionInfo& info);

/// The same of a switch, with the flag that takes it back: "--insecure,!--no-insecure".
std::string switch_flags_of(const OptionInfo& info);

/// The recognizer's options that are given as words.
struct RecognizerWords {
  std::string method = "ml";
  std::vector<std::string> classes;  ///< empty = all
  std::string touched_from = "unknown";
  std::string estimator = "sliding";
  std::size_t window = static_cast<std::size_t>(EstimatorOptions{}.window);
  std::size_t shift = static_cast<std::size_t>(EstimatorOptions{}.shift);
};

/// Sets the options in `recognizer` that `words` name. Returns an empty string or an error.
std::string resolve(const RecognizerWords& words, RecognizerOptions& recognizer);

/// The recognizer's part of the table of options; see for_each_option().
template <typename Words, typename Recognizer, typename Visit>
void for_each_recognizer_option(Words& words, Recognizer& recognizer, Visit&& visit) {
  constexpr double kMostSamples = 1e6;
  visit({"method",
         "ml (maximum likelihood: all classes fitted and weighed) or tree (local estimates alone)"},
        words.method);
  visit({"classes", "Class to consider, e.g. ellipse; may be repeated; none = all"}, words.classes);
  visit({"sigma_m", "Noise of samples that bring none; 0 = estimate it from the data [m]", 0, 1e3,
         "--sigma"},
        recognizer.sigma_m);
  visit({"recognized_probability", "RECOGNIZED needs a posterior of at least this", 0, 1},
        recognizer.recognized_probability);
  visit({"determined_fraction",
         "RECOGNIZED needs each parameter's standard deviation within this fraction of it", 0, 1e3},
        recognizer.determined_fraction);
  visit(
      {"form_deviation_m",
       "Stated form error of the parts, a standard deviation: half of a +- tolerance [m]", 0, 1e3},
      recognizer.form_deviation_m);
  visit({"unqualified_probe",
         "Nobody has measured the probe's lobes, radius and drift: let all that the samples allow "
         "of these count, except with a probe file. Default: if no noise is stated"},
        recognizer.unqualified_probe);
  visit({"touched_from",
         "Where round tips touch of which neither a material side nor a normal tells the side: "
         "outside (a pin, a boss), inside (a bore) or unknown"},
        words.touched_from);
  visit({"false_outlier_probability", "Chance that a clean scene loses a sample as a spike", 0, 1},
        recognizer.false_outlier_probability);
  visit({"most_samples_per_patch", "Samples of a patch before neighbours are merged", kFewestMeans,
         kMostSamples},
        recognizer.memory.most_samples_per_patch);
  visit({"most_patches", "Patches of an object before the oldest is forgotten", 1, 1024},
        recognizer.memory.most_patches);
  visit({"windows_per_patch", "Local estimates: windows of a patch", 1, 1e3},
        recognizer.contacts.windows_per_patch);
  visit({"least_windows", "Local estimates: fewest windows of all patches together", 1, 1e3},
        recognizer.contacts.least_windows);
  visit({"window_samples", "Local estimates: fewest samples of a window", 4, kMostSamples},
        recognizer.contacts.window_samples);
  visit({"estimator",
         "Local estimates: sliding (windows as long as the data allow), or finite-difference, "
         "circle, two-round or jet over windows of a fixed length"},
        words.estimator);
  visit({"window", "Samples of a fixed window (two-round: of each first-round window)", 5, 1e4},
        words.window);
  visit({"shift", "Samples from one first-round window of the two-round estimator to the next", 1,
         1e4},
        words.shift);
  visit({"tree_significance", "Tree: probability that a test rejects the true class", 0, 1},
        recognizer.tree.significance);
  visit({"tree_relative_floor", "Tree: standard deviation added to every estimate", 0, 1},
        recognizer.tree.relative_floor);
  visit({"tree_relative_tolerance",
         "Tree: above 0, the paper's plain tolerance in place of statistics", 0, 1,
         "--relative-tolerance"},
        recognizer.tree.relative_tolerance);
}

}  // namespace palpate
