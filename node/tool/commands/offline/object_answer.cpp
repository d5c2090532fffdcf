#include "node/tool/commands/offline/object_answer.h"

#include <algorithm>
#include <utility>

#include "core/qualification/probed_recognition.h"
#include "node/files/printable.h"
#include "node/files/quantity.h"
#include "node/wire/convert.h"

namespace palpate {
namespace {

std::int64_t newest_stamp_ns(const ContactGroup& group) {
  std::int64_t newest = 0;
  for (const ContactRun& run : group.runs) {
    for (const ContactSample& sample : run.samples) {
      newest = std::max(newest, sample.stamp_ns);
    }
  }
  return newest;
}

/// The file of that probe, or the only one there is: who gives one file means it.
const QualifiedProbe* probe_called(const std::string& name, const ProbeFiles& probes) {
  return probes.all().size() == 1 ? &probes.all().front() : probes.of(name);
}

}  // namespace

std::vector<const ProbeCharacter*> characters_of(const ContactGroup& group,
                                                 const ProbeFiles& probes,
                                                 std::vector<std::string>& files,
                                                 std::vector<std::string>& notes) {
  if (probes.all().empty()) return {};
  std::vector<const ProbeCharacter*> characters(group.probes.size(), nullptr);
  std::vector<bool> told(group.probes.size(), false);
  for (const ContactRun& run : group.runs) {
    if (told[run.context.probe]) continue;
    told[run.context.probe] = true;
    const std::string& name = group.probes[run.context.probe];
    const QualifiedProbe* probe = probe_called(name, probes);
    if (probe == nullptr) {
      notes.push_back("WARNING: no probe file is of probe " + printable(name));
      continue;
    }
    characters[run.context.probe] = &probe->character;
    if (std::find(files.begin(), files.end(), probe->file) == files.end()) {
      files.push_back(probe->file);
    }
    if (!probe->described.name().empty() && probe->described.name() != name) {
      notes.push_back("probe " + printable(name) + " is taken for " +
                      printable(probe->described.name()) + " of " + probe->file);
    }
    if (probe->described.verdict() == v1::QUALIFICATION_VERDICT_INSUFFICIENT) {
      notes.push_back("WARNING: " + probe->file + ": its qualification was insufficient");
    }
    const double radius = probe->character.tip_radius_m;
    const double stated = run.context.tip_radius_m;
    if (radius > 0.0 && stated > 0.0 && stated != radius) {
      notes.push_back("WARNING: the tip radius of " + probe->file + ", " + text_of_length(radius) +
                      ", counts, not that of the samples, " + text_of_length(stated));
    } else if (!(radius > 0.0) && stated > 0.0) {
      notes.push_back("WARNING: " + probe->file +
                      " is of a probe that tells points of the surface, but the samples state a "
                      "tip radius: " +
                      text_of_length(stated) + " is taken off besides the file's offset");
    }
  }
  return characters;
}

void fill_origin(const ContactGroup& group, std::chrono::steady_clock::duration taken,
                 v1::Recognition& answer) {
  answer.mutable_header()->set_source(group.file);
  answer.set_group(group.name);
  answer.set_object(group.object);
  answer.set_newest_sample_stamp_ns(newest_stamp_ns(group));
  answer.set_compute_ns(std::chrono::duration_cast<std::chrono::nanoseconds>(taken).count());
}

Answered recognise(const FitInput& input, const RecognizerOptions& options,
                   const ProbeFiles& probes, std::vector<std::string>& notes) {
  const ContactGroup& group = input.group;
  Answered answer;
  AddResult added;
  std::chrono::steady_clock::duration taken{};
  std::vector<std::string> probe_files;
  std::vector<std::string> probe_notes;
  if (probes.all().empty()) {
    Recognizer recognizer(options);
    added = add_group(group, recognizer);
    const auto start = std::chrono::steady_clock::now();
    answer.recognition = recognizer.recognize();
    taken = std::chrono::steady_clock::now() - start;
  } else {
    const std::vector<const ProbeCharacter*> characters =
        characters_of(group, probes, probe_files, probe_notes);
    SampleMemory memory(options.memory);
    for (const ContactRun& run : group.runs)
      added += memory.add(run.context, run.samples, run.details);
    const auto start = std::chrono::steady_clock::now();
    ProbedRecognition result = recognise_probed(memory, characters, options);
    taken = std::chrono::steady_clock::now() - start;
    answer.recognition = std::move(result.recognition);
    answer.recognition.forgotten_count = added.forgotten;
    answer.recognition.simplified_count += added.detailed - result.added.detailed;
    if (!result.corrected && !probe_files.empty()) {
      probe_files.clear();
      probe_notes.push_back(
          "WARNING: no curve was found to take normals from: the probe's offset is not taken off");
    }
  }
  to_wire(
      answer.recognition,
      [&](std::uint32_t probe, std::uint32_t patch) {
        return ContactSource{group.probes[probe], patch};
      },
      answer.wire);
  fill_origin(group, taken, answer.wire);
  answer.wire.mutable_probe_files()->Assign(probe_files.begin(), probe_files.end());
  notes = notes_for(input, options.memory, added);
  notes.insert(notes.end(), probe_notes.begin(), probe_notes.end());
  if (const std::size_t count = answer.recognition.simplified_count; count > 0) {
    notes.push_back(std::to_string(count) +
                    " samples have a normal or a covariance that does not count in full: both need "
                    "the noise of every sample, and normals along a stroke a class whose "
                    "residuals err independently of their neighbours'; the side of a round tip "
                    "counts (palpate fit --class uses all of it)");
  }
  return answer;
}

}  // namespace palpate
