#include "node/tool/contact_groups.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "node/files/counted.h"
#include "node/files/printable.h"

namespace palpate {

std::vector<ContactGroup> contact_groups(const std::string& file, const ContactTable& table) {
  std::vector<ContactGroup> groups;
  const bool detailed = std::any_of(table.rows.begin(), table.rows.end(),
                                    [](const ContactRow& row) { return says_more(row.detail); });
  std::map<std::pair<std::size_t, std::uint64_t>, std::size_t> index_of;
  for (const ContactRow& row : table.rows) {
    const auto [found, is_new] = index_of.try_emplace({row.group, row.object}, groups.size());
    if (is_new) {
      groups.push_back({file, table.names[row.group], row.object, {}, {}});
    }
    ContactGroup& group = groups[found->second];
    const std::string& probe = table.names[row.probe];
    const auto known = std::find(group.probes.begin(), group.probes.end(), probe);
    PatchContext context = row.context;
    context.probe = static_cast<std::uint32_t>(known - group.probes.begin());
    if (known == group.probes.end()) {
      group.probes.push_back(probe);
    }
    const bool continues = !group.runs.empty() &&
                           group.runs.back().context.probe == context.probe &&
                           group.runs.back().context.patch == context.patch;
    if (!continues) {
      group.runs.push_back({context, {}, {}});
    }
    group.runs.back().samples.push_back(row.sample);
    if (detailed) group.runs.back().details.push_back(row.detail);
  }
  return groups;
}

std::string object_of(const ContactGroup& group, bool is_alone) {
  if (is_alone) return {};
  return "group " + printable_path(group.name) + ", object " + std::to_string(group.object) + ": ";
}

std::string note_of_unused_detail(const ContactGroup& group) {
  std::size_t count = 0;
  for (const ContactRun& run : group.runs) {
    count +=
        static_cast<std::size_t>(std::count_if(run.details.begin(), run.details.end(), says_more));
  }
  if (count == 0) return {};
  return "of " + std::to_string(count) +
         " samples with a measured normal or covariance the position and mean noise count alone "
         "(palpate fit --class uses all of it)";
}

std::string note_of_unused_sigma(const ContactGroup& group, double sigma_m) {
  constexpr double kRounding = 1e-9;  // of the change to metres
  if (!(sigma_m > 0.0)) return {};
  std::size_t samples = 0;
  std::size_t stated = 0;
  bool is_another = false;
  bool has_covariance = false;
  for (const ContactRun& run : group.runs) {
    samples += run.samples.size();
    for (const ContactSample& sample : run.samples) {
      if (!(sample.sigma_m > 0.0)) continue;
      ++stated;
      is_another |= std::abs(sample.sigma_m - sigma_m) > kRounding * sigma_m;
    }
    for (const SampleDetail& detail : run.details) has_covariance |= detail.covariance_m2.x() > 0.0;
  }
  if (!is_another) return {};
  const std::string column = has_covariance ? "columns sigma, cov_*" : "column sigma";
  return stated == samples
             ? "--sigma is not used: the noise that the file states for every sample (" + column +
                   ") holds"
             : "--sigma is used for " + counted(samples - stated, "sample") + " of " +
                   std::to_string(samples) + ": for the others the noise that the file states (" +
                   column + ") holds";
}

AddResult add_group(const ContactGroup& group, Recognizer& recognizer) {
  AddResult sum;
  for (const ContactRun& run : group.runs) {
    sum += recognizer.add(run.context, run.samples, run.details);
  }
  return sum;
}

}  // namespace palpate
