#include "node/check/group_check.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "core/recognition/counted/fewest_places.h"
#include "node/files/counted.h"
#include "node/files/quantity.h"

namespace palpate {
namespace {

/// A touched part is larger than its dust and smaller than this. [m]
constexpr double kLargestObjectM = 2.0;
constexpr double kSmallestObjectM = 1e-5;

/// The patches of each probe, runs of one patch joined.
std::map<std::string, std::vector<CheckedPatch>> checked_patches(const ContactGroup& group,
                                                                 double sigma_m) {
  std::map<std::string, std::vector<CheckedPatch>> probes;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> place_of;
  for (const ContactRun& run : group.runs) {
    std::vector<CheckedPatch>& patches = probes[group.probes[run.context.probe]];
    const auto [place, is_new] =
        place_of.try_emplace({run.context.probe, run.context.patch}, patches.size());
    if (is_new) {
      patches.push_back(
          {run.context.patch, group.object, run.context.tip_radius_m, run.context.material_side});
    }
    CheckedPatch& patch = patches[place->second];
    for (std::size_t i = 0; i < run.samples.size(); ++i) {
      const ContactSample& sample = run.samples[i];
      patch.take(sample.position_m, sample.sigma_m > 0.0 ? sample.sigma_m : sigma_m,
                 run.details.empty() ? nullptr : &run.details[i]);
    }
  }
  return probes;
}

/// Of all samples together: single touches have no extent of their own. Returns it. [m]
double judge_extent(const ContactGroup& group, CheckedSource source,
                    std::vector<Finding>* findings) {
  Vec2 low = group.runs.front().samples.front().position_m;
  Vec2 high = low;
  for (const ContactRun& run : group.runs) {
    for (const ContactSample& sample : run.samples) {
      low = low.cwiseMin(sample.position_m);
      high = high.cwiseMax(sample.position_m);
    }
  }
  const double extent = (high - low).norm();
  const std::string what = "the samples extend over " + text_of_length(extent);
  if (extent > kLargestObjectM) {
    findings->push_back(
        {Severity::Warning, "", what,
         cure_of(source, "were these millimetres?",
                 "were these millimetres? Then say --unit mm (or um, in)",
                 "were these millimetres? Then say unit=\"mm\" (or \"um\", \"in\")"),
         true});
  } else if (extent > 0.0 && extent < kSmallestObjectM) {
    findings->push_back(
        {Severity::Warning, "", what,
         cure_of(source, "is the unit right?", "is the unit right? --unit names another",
                 "is the unit right? unit= names another"),
         true});
  }
  return extent;
}

void judge_stamps(const ContactGroup& group, std::vector<Finding>* findings) {
  // Strokes may each have a clock of their own.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::int64_t> newest;
  std::map<std::uint32_t, std::size_t> backwards;
  struct Stamps {
    std::int64_t first_ns = 0;
    std::size_t count = 0;
    bool are_one = true;
  };
  std::map<std::uint32_t, Stamps> of_probe;
  for (const ContactRun& run : group.runs) {
    for (const ContactSample& sample : run.samples) {
      if (sample.stamp_ns == 0) continue;
      Stamps& stamps = of_probe[run.context.probe];
      if (stamps.count++ == 0) stamps.first_ns = sample.stamp_ns;
      stamps.are_one &= sample.stamp_ns == stamps.first_ns;
      const auto [last, is_first] =
          newest.try_emplace({run.context.probe, run.context.patch}, sample.stamp_ns);
      if (sample.stamp_ns < last->second) ++backwards[run.context.probe];
      last->second = sample.stamp_ns;
    }
  }
  for (const auto& [probe, count] : backwards) {
    findings->push_back({Severity::Error, group.probes[probe],
                         counted(count, "stamp") + " earlier than the one before in its patch",
                         "sort the rows of a patch in the order in which they were taken", true});
  }
  for (const auto& [probe, stamps] : of_probe) {
    if (stamps.count < 2 || !stamps.are_one) continue;
    findings->push_back({Severity::Warning, group.probes[probe], one_stamp_text(stamps.count),
                         "give each sample the time when it was taken, or none"});
  }
}

/// A radius in millimetres where metres are asked.
void judge_tips(const ContactGroup& group, double extent, CheckedSource source,
                std::vector<Finding>* findings) {
  // Styli end in balls of up to 30 mm across. A tip may be larger than a bore is wider than it.
  constexpr double kLargestTipM = 0.015;
  double radius = 0.0;
  for (const ContactRun& run : group.runs) radius = std::max(radius, run.context.tip_radius_m);
  if (extent > 0.0 && radius > std::max(kLargestTipM, extent)) {
    findings->push_back({Severity::Warning, "",
                         "a tip radius of " + text_of_length(radius) +
                             " is larger than all that is touched, " + text_of_length(extent),
                         cure_of(source, "was it in millimetres?",
                                 "was it in millimetres? --tip-radius is metres whatever the unit",
                                 "is tip_radius in the unit of the points?"),
                         true});
  }
}

/// Strokes that are the same to the last bit: one that was saved twice.
void judge_copies(const std::string& probe, const std::vector<CheckedPatch>& patches,
                  std::vector<Finding>* findings) {
  constexpr std::size_t kFewest = 8;  // touches of a coarse machine come again by chance
  std::map<std::vector<std::pair<double, double>>, std::uint32_t> seen;
  std::size_t copies = 0;
  std::string first;
  for (const CheckedPatch& patch : patches) {
    if (patch.positions.size() < kFewest) continue;
    std::vector<std::pair<double, double>> places;
    for (const Vec2& p : patch.positions) places.emplace_back(p.x(), p.y());
    const auto [original, is_new] = seen.try_emplace(std::move(places), patch.number);
    if (is_new) continue;
    if (copies++ == 0) {
      first = "patch " + std::to_string(patch.number) + " is one of patch " +
              std::to_string(original->second);
    }
  }
  if (copies > 0) {
    findings->push_back({Severity::Error, probe,
                         counted(copies, "patch is a copy", "patches are copies") +
                             " of others, sample by sample (" + first + ")",
                         "leave copies out: their noise is counted as if it were new", true});
  }
}

}  // namespace

std::optional<Finding> too_few_places(const ContactGroup& group, std::size_t patches) {
  std::set<std::pair<double, double>> places;
  for (const ContactRun& run : group.runs) {
    for (const ContactSample& sample : run.samples) {
      places.insert({sample.position_m.x(), sample.position_m.y()});
    }
  }
  const std::size_t fewest = patches < kFewestPatches ? kFewestPlaces : kFewestPatches;
  if (places.size() >= fewest) {
    return std::nullopt;
  }
  return Finding{Severity::Warning, "", "only " + counted(places.size(), "place") + " touched",
                 "there is no answer from fewer than " + std::to_string(kFewestPlaces) + ", or " +
                     std::to_string(kFewestPatches) +
                     " patches, unless fit --class names the class",
                 true};
}

std::vector<Finding> check_group(const ContactGroup& group, double sigma_m, CheckedSource source) {
  std::vector<Finding> findings;
  const double extent = judge_extent(group, source, &findings);
  const bool extent_is_told = !findings.empty();
  judge_tips(group, extent, source, &findings);
  judge_stamps(group, &findings);
  for (const auto& [probe, patches] : checked_patches(group, sigma_m)) {
    std::vector<Finding> of_probe;
    judge_patches(probe, patches, source, &of_probe);
    judge_copies(probe, patches, &of_probe);
    for (Finding& finding : of_probe) {
      // Said once: of all samples, not of each probe again.
      const bool is_extent = finding.what.find("extends over") != std::string::npos;
      if (!(extent_is_told && is_extent)) findings.push_back(std::move(finding));
    }
  }
  sort_findings(&findings);
  return findings;
}

std::string whose(const Finding& finding) {
  return finding.object + (finding.probe.empty() ? "" : finding.probe + ": ");
}

std::string sentence_of(const Finding& finding) {
  return whose(finding) + finding.what + (finding.cure.empty() ? "" : ": " + finding.cure);
}

}  // namespace palpate
