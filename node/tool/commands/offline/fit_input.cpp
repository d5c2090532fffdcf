#include "node/tool/commands/offline/fit_input.h"

#include <algorithm>
#include <map>
#include <utility>

#include "node/check/group_check.h"
#include "node/files/counted.h"
#include "node/files/printable.h"

namespace palpate {
namespace {

/// Samples of each patch.
std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> patch_sizes(
    const ContactGroup& group) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> sizes;
  for (const ContactRun& run : group.runs) {
    sizes[{run.context.probe, run.context.patch}] += run.samples.size();
  }
  return sizes;
}

bool all_have_sigma(const ContactGroup& group) {
  return std::all_of(group.runs.begin(), group.runs.end(), [](const ContactRun& run) {
    return std::all_of(run.samples.begin(), run.samples.end(),
                       [](const ContactSample& sample) { return sample.sigma_m > 0.0; });
  });
}

std::size_t samples_of(const ContactGroup& group) {
  std::size_t samples = 0;
  for (const ContactRun& run : group.runs) samples += run.samples.size();
  return samples;
}

/// Whether a stroke of it leads to and fro instead of along the part.
bool has_no_order(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& finding) { return finding.has_no_order; });
}

/// Makes every sample a patch of its own.
void part_into_touches(ContactGroup& group) {
  std::map<std::uint32_t, std::uint32_t> counts;  // by probe
  std::vector<ContactRun> touches;
  for (const ContactRun& run : group.runs) {
    for (std::size_t i = 0; i < run.samples.size(); ++i) {
      ContactRun touch{run.context, {run.samples[i]}};
      if (!run.details.empty()) touch.details = {run.details[i]};
      touch.context.patch = counts[run.context.probe]++;
      touches.push_back(std::move(touch));
    }
  }
  group.runs = std::move(touches);
}

}  // namespace

Result<std::vector<FitInput>> read_fit_input(const std::string& file,
                                             const ContactFileOptions& options, double sigma_m) {
  using Read = Result<std::vector<FitInput>>;
  const Result<ContactFile> read = read_contact_file(file, options);
  if (!read) return Read::fail(read.error);
  std::vector<FitInput> inputs;
  std::vector<ContactGroup> groups = contact_groups(file, read.value->table);
  for (ContactGroup& group : groups) {
    FitInput input{std::move(group), read.value->notes, {}, false, groups.size() == 1};
    input.noise_is_known = all_have_sigma(input.group);
    std::vector<Finding> findings = check_group(input.group, sigma_m);
    // What is no stroke is not read as one, unless that or the patches were said. The memory counts
    // its touches at each one that comes: ten times as many take a hundred times as long.
    constexpr std::size_t kMostTouches = 20'000;  // about a second
    if (!options.touches && !read.value->has_patches && has_no_order(findings) &&
        samples_of(input.group) <= kMostTouches) {
      part_into_touches(input.group);
      findings = check_group(input.group, sigma_m);
      input.warnings.emplace_back(
          "the rows lead to and fro over the whole part, in no order along it: each is taken as a "
          "touch of its own (as by --touches; --strokes takes them as they stand)");
    }
    for (const Finding& finding : findings) {
      if (finding.spoils_answer) input.warnings.push_back(sentence_of(finding));
    }
    inputs.push_back(std::move(input));
  }
  return Read::ok(std::move(inputs));
}

MemoryOptions memory_for(const ContactGroup& group, MemoryOptions memory,
                         bool patches_are_bounded) {
  if (!patches_are_bounded) {
    const std::size_t patches = patch_sizes(group).size();
    memory.most_patches = std::max(memory.most_patches, patches);
    memory.most_lone_touches = std::max(memory.most_lone_touches, patches);
  }
  return memory;
}

std::vector<std::string> notes_for(const FitInput& input, const MemoryOptions& memory,
                                   const AddResult& added) {
  std::vector<std::string> notes;
  for (const std::string& warning : input.warnings) notes.push_back("WARNING: " + warning);
  notes.insert(notes.end(), input.notes.begin(), input.notes.end());
  const auto sizes = patch_sizes(input.group);
  if (added.forgotten > 0) {
    notes.push_back("forgotten: " + counted(added.forgotten, "sample") + " of the oldest of " +
                    counted(sizes.size(), "patch", "patches") + " (--most-patches)");
  }
  const auto long_ones = std::count_if(sizes.begin(), sizes.end(), [&](const auto& patch) {
    return patch.second > memory.most_samples_per_patch;
  });
  if (long_ones > 0) {
    notes.push_back("used as means of neighbours: the samples of " +
                    counted(static_cast<std::size_t>(long_ones), "patch", "patches") +
                    " of more than " + std::to_string(memory.most_samples_per_patch) +
                    " (--most-samples-per-patch)");
  }
  if (added.repeated > 0) {
    notes.push_back("dropped: " + counted(added.repeated, "sample") +
                    " at exactly the place of the one before");
  }
  return notes;
}

std::string with_notes(std::string json_line, const std::vector<std::string>& notes) {
  const std::size_t end = json_line.rfind('}');
  if (notes.empty() || end == std::string::npos) return json_line;
  std::string field = end > 1 ? ",\"notes\":[" : "\"notes\":[";
  for (const std::string& note : notes) {
    field += field.back() == '[' ? "\"" : ",\"";
    for (const char c : printable(note, note.size())) {
      if (c == '"' || c == '\\') field += '\\';
      field += c;
    }
    field += '"';
  }
  return json_line.insert(end, field + "]");
}

}  // namespace palpate
