// The strokes of samples that come in turns: runs of one patch, joined.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "core/recognition/samples/contact_run.h"

namespace palpate {

struct JoinedRuns {
  std::vector<ContactRun> runs;  ///< one per patch, in the order in which the patches begin
  /// Of each sample, in the order of the runs as given: its place among those of all joined runs.
  std::vector<std::size_t> place_of;
};

/// Where probes take turns, a patch goes on where its probe comes back to it: its neighbours along
/// the part, and its direction of travel, are those of the patch. Runs of one patch that state
/// another tip radius or side are strokes of their own, as they are to the recogniser.
/// O(samples log(patches)).
inline JoinedRuns joined_runs(std::span<const ContactRun> runs) {
  JoinedRuns joined;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> latest;
  std::vector<std::pair<std::size_t, std::size_t>> moved;  // joined run, and place in it
  for (const ContactRun& run : runs) {
    const std::size_t next = joined.runs.size();
    const auto [found, is_new] = latest.try_emplace({run.context.probe, run.context.patch}, next);
    if (!is_new) {
      const PatchContext& before = joined.runs[found->second].context;
      const bool continues = before.tip_radius_m == run.context.tip_radius_m &&
                             before.material_side == run.context.material_side;
      if (!continues) found->second = next;
    }
    if (found->second == next) joined.runs.push_back({run.context, {}, {}});
    ContactRun& into = joined.runs[found->second];
    for (const ContactSample& sample : run.samples) {
      moved.emplace_back(found->second, into.samples.size());
      into.samples.push_back(sample);
    }
    if (run.details.empty() && into.details.empty()) continue;
    into.details.resize(into.samples.size() - run.samples.size());
    into.details.insert(into.details.end(), run.details.begin(), run.details.end());
    into.details.resize(into.samples.size());
  }
  std::vector<std::size_t> begins;
  std::size_t begin = 0;
  for (const ContactRun& run : joined.runs) {
    begins.push_back(begin);
    begin += run.samples.size();
  }
  for (const auto& [run, place] : moved) joined.place_of.push_back(begins[run] + place);
  return joined;
}

}  // namespace palpate
