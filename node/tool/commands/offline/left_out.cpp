#include "node/tool/commands/offline/left_out.h"

#include <charconv>
#include <set>
#include <string_view>
#include <utility>

#include "node/files/printable.h"

namespace palpate {

Result<std::vector<std::size_t>> left_out_of(const std::vector<std::string>& words,
                                             const ContactGroup& group) {
  using Numbers = Result<std::vector<std::size_t>>;
  std::size_t samples = 0;
  for (const ContactRun& run : group.runs) samples += run.samples.size();
  std::set<std::size_t> numbers;
  for (const std::string& word : words) {
    const auto number = [&](std::string_view text) {
      std::size_t value = 0;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      const bool whole = error == std::errc() && end == text.data() + text.size();
      return whole && value <= samples ? value : 0;
    };
    const std::size_t dash = word.find('-');
    const std::size_t first = number(std::string_view(word).substr(0, dash));
    const std::size_t last =
        dash == std::string::npos ? first : number(std::string_view(word).substr(dash + 1));
    if (first == 0 || last < first) {
      return Numbers::fail("--leave-out: '" + printable(word) +
                           "' names no samples: they are 1 to " + std::to_string(samples) +
                           ", as in 3,17 or 1-5");
    }
    for (std::size_t i = first; i <= last; ++i) numbers.insert(numbers.end(), i);
  }
  if (numbers.size() == samples) {
    return Numbers::fail("--leave-out: leaves none of the " + std::to_string(samples) + " samples");
  }
  return Numbers::ok({numbers.begin(), numbers.end()});
}

ContactGroup without_samples(const ContactGroup& group, std::span<const std::size_t> left_out) {
  const std::set<std::size_t> is_out(left_out.begin(), left_out.end());
  ContactGroup kept = group;
  kept.runs.clear();
  std::size_t number = 0;
  for (const ContactRun& run : group.runs) {
    ContactRun rest{run.context, {}, {}};
    for (std::size_t i = 0; i < run.samples.size(); ++i) {
      if (is_out.contains(++number)) continue;
      rest.samples.push_back(run.samples[i]);
      if (!run.details.empty()) rest.details.push_back(run.details[i]);
    }
    if (!rest.samples.empty()) kept.runs.push_back(std::move(rest));
  }
  return kept;
}

}  // namespace palpate
