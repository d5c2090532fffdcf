#include "node/tool/commands/fit_input.h"

#include <algorithm>
#include <map>
#include <utility>

#include "node/files/printable.h"
#include "node/tool/commands/file_check.h"

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

}  // namespace

Result<std::vector<FitInput>> read_fit_input(const std::string& file,
                                             const ContactFileOptions& options, double sigma_m) {
  using Read = Result<std::vector<FitInput>>;
  const Result<ContactFile> read = read_contact_file(file, options);
  if (!read) return Read::fail(read.error);
  std::vector<FitInput> inputs;
  for (ContactGroup& group : contact_groups(file, read.value->table)) {
    FitInput input{std::move(group), read.value->notes, {}, false};
    input.noise_is_known = all_have_sigma(input.group);
    for (const Finding& finding : check_group(input.group, sigma_m)) {
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
    notes.push_back(std::to_string(added.forgotten) + " samples of the oldest of " +
                    std::to_string(sizes.size()) + " patches are forgotten (--most-patches)");
  }
  const auto long_ones = std::count_if(sizes.begin(), sizes.end(), [&](const auto& patch) {
    return patch.second > memory.most_samples_per_patch;
  });
  if (long_ones > 0) {
    notes.push_back(std::to_string(long_ones) + " patches of more than " +
                    std::to_string(memory.most_samples_per_patch) +
                    " samples are used as means of neighbours (--most-samples-per-patch)");
  }
  if (added.repeated > 0) {
    notes.push_back(std::to_string(added.repeated) +
                    " samples at exactly the place of the one before are dropped");
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
