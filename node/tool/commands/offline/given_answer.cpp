#include "node/tool/commands/offline/given_answer.h"

#include <chrono>

#include "node/tool/commands/offline/answer_notes.h"
#include "node/tool/commands/offline/object_answer.h"
#include "node/wire/given_class_answer.h"

namespace palpate {

v1::GivenClassAnswer fit_given(const GivenClass& given, const ContactGroup& group,
                               const RecognizerOptions& options, const ProbeFiles& probes,
                               std::vector<std::string>& notes) {
  std::vector<std::string> files;
  const std::vector<const ProbeCharacter*> characters = characters_of(group, probes, files, notes);
  const auto start = std::chrono::steady_clock::now();
  v1::GivenClassAnswer answer =
      given_class_answer(given.curve_class, group.runs, characters, given.left_out, options);
  if (answer.recognition().has_parameters()) {
    answer.mutable_recognition()->mutable_probe_files()->Assign(files.begin(), files.end());
  } else if (!files.empty()) {
    notes.emplace_back("WARNING: without a curve the probe's offset is not taken off");
  }
  bool normals = false;
  bool known = true;
  for (const ContactRun& run : group.runs) {
    for (const SampleDetail& detail : run.details) normals |= detail.normal_sigma_rad > 0.0;
    for (const ContactSample& sample : run.samples) {
      known &= sample.sigma_m > 0.0 || options.sigma_m > 0.0;
    }
  }
  if (normals && !known && !answer.sigma_stated()) {
    notes.emplace_back(
        "WARNING: the measured normals do not count: not every sample's noise is known (--sigma)");
  }
  if (const std::string note = note_of_misfit(answer); !note.empty()) notes.push_back(note);
  if (!files.empty() && answer.sigma_stated()) {
    notes.emplace_back("chi-square counts the probe's white noise alone, not its drift");
  }
  fill_origin(group, std::chrono::steady_clock::now() - start, *answer.mutable_recognition());
  return answer;
}

}  // namespace palpate
