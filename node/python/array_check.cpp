#include "node/python/array_check.h"

#include <algorithm>

#include "node/check/approach_check.h"
#include "node/check/group_check.h"

namespace palpate {

void ArrayCheck::add(PatchContext context, std::span<const ContactSample> samples,
                     std::span<const SampleDetail> details) {
  constexpr std::size_t kMostKept = 1 << 16;  // samples, but for those of the last run
  if (samples.empty()) return;
  context.probe = index_of(context.probe);
  const bool continues = !group_.runs.empty() &&
                         group_.runs.back().context.probe == context.probe &&
                         group_.runs.back().context.patch == context.patch;
  if (!continues) group_.runs.push_back({context, {}, {}});
  ContactRun& run = group_.runs.back();
  if (!details.empty() || !run.details.empty()) {
    run.details.resize(run.samples.size());
    run.details.insert(run.details.end(), details.begin(), details.end());
    run.details.resize(run.samples.size() + samples.size());
  }
  run.samples.insert(run.samples.end(), samples.begin(), samples.end());
  count_ += samples.size();
  if (count_ > kMostKept) forget_oldest();
}

std::vector<std::string> ArrayCheck::warnings() const {
  std::vector<std::string> sentences;
  if (group_.runs.empty()) return sentences;
  for (Finding& finding : check_group(group_, 0.0, CheckedSource::Arrays)) {
    if (!finding.spoils_answer) continue;
    finding.probe = finding.probe.empty() || group_.probes.size() == 1 ? std::string()
                                                                       : "probe " + finding.probe;
    sentences.push_back(sentence_of(finding));
  }
  return sentences;
}

std::optional<std::string> ArrayCheck::approaches() const {
  const auto finding = judge_approaches(group_, true, {}, CheckedSource::Arrays);
  return finding ? std::optional(sentence_of(*finding)) : std::nullopt;
}

/// Until half of those that may be kept are left, so that a long stream of touches costs no more
/// than a short one.
void ArrayCheck::forget_oldest() {
  constexpr std::size_t kLeft = 1 << 15;
  auto kept = group_.runs.begin();
  for (; count_ > kLeft && kept + 1 != group_.runs.end(); ++kept) {
    count_ -= kept->samples.size();
  }
  group_.runs.erase(group_.runs.begin(), kept);
}

/// Of a probe's number in the group.
std::uint32_t ArrayCheck::index_of(std::uint32_t probe) {
  const std::string name = std::to_string(probe);
  const auto known = std::find(group_.probes.begin(), group_.probes.end(), name);
  const auto index = static_cast<std::uint32_t>(known - group_.probes.begin());
  if (known == group_.probes.end()) group_.probes.push_back(name);
  return index;
}

}  // namespace palpate
