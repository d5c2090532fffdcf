#include "node/check/approach_check.h"

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "node/check/straight_ends.h"
#include "node/files/counted.h"
#include "node/files/quantity.h"

namespace palpate {
namespace {

using Numbers = std::span<const std::size_t>;

struct NumberedStroke {
  std::vector<Vec2> positions;
  std::vector<std::size_t> numbers;  ///< of its samples, increasing
};

/// By probe and patch. Runs of a patch are joined.
std::map<std::pair<std::uint32_t, std::uint32_t>, NumberedStroke> strokes_of(
    const ContactGroup& group, Numbers left_out) {
  const std::set<std::size_t> is_out(left_out.begin(), left_out.end());
  std::map<std::pair<std::uint32_t, std::uint32_t>, NumberedStroke> strokes;
  std::size_t number = 0;
  for (const ContactRun& run : group.runs) {
    NumberedStroke& stroke = strokes[{run.context.probe, run.context.patch}];
    for (const ContactSample& sample : run.samples) {
      if (is_out.contains(++number)) continue;
      stroke.positions.push_back(sample.position_m);
      stroke.numbers.push_back(number);
    }
  }
  return strokes;
}

/// "1-8,12": as --leave-out has it.
std::string ranges_of(Numbers numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    if (!text.empty()) text += ',';
    text += std::to_string(numbers[i]);
    if (last > i) {
      text += '-';
      text += std::to_string(numbers[last]);
    }
    i = last + 1;
  }
  return text;
}

std::string whole_degrees(double rad) { return number(std::round(rad * kDegrees)) + " degrees"; }

/// "the first 8 samples (1-8) at 88 degrees"; only files number their samples.
std::string text_of_end(const char* which, const StraightEnd& end, Numbers numbers,
                        CheckedSource source) {
  const std::string range =
      source == CheckedSource::File ? " (" + ranges_of(numbers) + ")" : std::string();
  return std::string("the ") + which + " " + counted(end.samples, "sample") + range + " at " +
         whole_degrees(end.corner_rad);
}

}  // namespace

std::optional<Finding> judge_approaches(const ContactGroup& group, bool is_alone, Numbers left_out,
                                        CheckedSource source) {
  constexpr std::size_t kMostNamed = 3;
  std::size_t count = 0;
  std::string named;
  std::set<std::size_t> all;
  for (const auto& [key, stroke] : strokes_of(group, left_out)) {
    const StraightEnds ends = straight_ends(stroke.positions);
    const Numbers first = Numbers(stroke.numbers).first(ends.first.samples);
    const Numbers last = Numbers(stroke.numbers).last(ends.last.samples);
    if (first.empty() && last.empty()) continue;
    all.insert(first.begin(), first.end());
    all.insert(last.begin(), last.end());
    if (++count > kMostNamed) continue;
    named += count > 1 ? "; " : "";
    if (group.probes.size() > 1) named += "probe " + group.probes[key.first] + ", ";
    named += "patch " + std::to_string(key.second) + ": ";
    if (!first.empty()) named += text_of_end("first", ends.first, first, source);
    if (!first.empty() && !last.empty()) named += ", ";
    if (!last.empty()) named += text_of_end("last", ends.last, last, source);
  }
  if (count == 0) return std::nullopt;
  if (count > kMostNamed) named += "; and so on";
  all.insert(left_out.begin(), left_out.end());
  const std::vector<std::size_t> numbers(all.begin(), all.end());
  const std::string cure =
      source == CheckedSource::Stream   ? "publish samples in contact alone"
      : source == CheckedSource::Arrays ? "leave these samples out"
      : is_alone                        ? "leave it out: fit --leave-out " + ranges_of(numbers)
                 : "take its rows out of the file (samples are numbered within their group and "
                   "object)";
  return Finding{Severity::Warning, "",
                 counted(count, "stroke runs", "strokes run") + " straight at an end and meet" +
                     (count == 1 ? "s" : "") + " the rest at a corner (" + named + ")",
                 "if that is the approach to the part or the retract from it, " + cure, true};
}

}  // namespace palpate
