#include "node/groups/group_recognizer.h"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/qualification/probed_recognition.h"
#include "node/wire/given_class_answer.h"

namespace palpate {
namespace {

std::int64_t thread_processor_ns() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::chrono::nanoseconds(std::chrono::seconds(now.tv_sec)).count() + now.tv_nsec;
}

}  // namespace

std::size_t GroupRecognizer::take(const QueuedContacts& message,
                                  std::span<const ContactSample> samples,
                                  std::span<const SampleDetail> details) {
  if (message.begins_object) {
    recognizer_.reset();
    touched_.clear();
    forgotten_ = 0;
    simplified_ = 0;
    members_.clear();
    frame_ = message.frame;
    object_ = message.object;
  }
  auto member = std::find_if(members_.begin(), members_.end(),
                             [&](const Member& known) { return known.probe == message.probe; });
  if (member == members_.end()) {
    members_.push_back({message.probe, PatchNumbering()});
    member = members_.end() - 1;
  }
  if (message.continuity == Continuity::Anew) member->patches.end_run();

  PatchContext context;
  context.probe = static_cast<std::uint32_t>(member - members_.begin());
  context.patch =
      member->patches.run_of(message.patch, message.continuity == Continuity::SamplesMissing,
                             gap_break_spacings_, samples);
  context.tip_radius_m = message.tip_radius_m;
  context.material_side = message.material_side;
  AddResult added = recognizer_.add(context, samples, details);
  if (probe_files || given_class_) {
    const AddResult kept = touched_.add(context, samples, details);
    forgotten_ += kept.forgotten;
    simplified_ += kept.detailed;
    if (given_class_) added = kept;
  }

  newest_.source = message.probe;
  newest_.epoch = message.epoch;
  newest_.seq = message.seq;
  newest_.sample_stamp_ns =
      message.newest_sample_stamp_ns;  // not a maximum: a wrong stamp must not persist
  return samples.size() - added.accepted;
}

/// Indexed by member; empty if no member has a probe file. `files`: names of the probe files used.
std::vector<const ProbeCharacter*> GroupRecognizer::qualified_probes(
    std::vector<std::string>& files) const {
  std::vector<const ProbeCharacter*> probes;
  for (const Member& member : members_) {
    const QualifiedProbe* probe = probe_files ? probe_files->of(member.probe) : nullptr;
    probes.push_back(probe == nullptr ? nullptr : &probe->character);
    if (probe != nullptr && std::find(files.begin(), files.end(), probe->file) == files.end()) {
      files.push_back(probe->file);
    }
  }
  if (files.empty()) probes.clear();
  return probes;
}

ContactSourceOf GroupRecognizer::sources() const {
  return [this](std::uint32_t probe, std::uint32_t run) { return source_of(probe, run); };
}

/// As `palpate fit` and `palpate fit --probe` do.
void GroupRecognizer::answer_by_search() {
  std::vector<std::string> files;
  const std::vector<const ProbeCharacter*> probes = qualified_probes(files);
  if (probes.empty()) {
    to_wire(recognizer_.recognize(), sources(), answer.recognition);
    return;
  }
  // Estimates of a round tip need an answer that shows on which side the material is.
  if (wants_estimates) (void)recognizer_.recognize();
  ProbedRecognition found = recognise_probed(touched_, probes, options_);
  found.recognition.forgotten_count = forgotten_;
  found.recognition.simplified_count += simplified_ - found.added.detailed;
  to_wire(found.recognition, sources(), answer.recognition);
  if (found.corrected) {
    answer.recognition.mutable_probe_files()->Assign(files.begin(), files.end());
  }
}

/// As `palpate fit --class` does.
void GroupRecognizer::answer_of_given_class() {
  std::vector<std::string> files;
  const std::vector<const ProbeCharacter*> probes = qualified_probes(files);
  if (wants_estimates) (void)recognizer_.recognize();
  std::vector<ContactRun> runs;
  for (const StoredPatch& patch : touched_.patches()) runs.push_back(as_contacts(patch));
  v1::GivenClassAnswer given = given_class_answer(*given_class_, runs, probes, {}, options_);
  v1::Recognition& message = answer.recognition;
  message = std::move(*given.mutable_recognition());
  message.set_sample_count(touched_.sample_count());
  message.set_forgotten_count(forgotten_);
  if (message.has_parameters()) message.mutable_probe_files()->Assign(files.begin(), files.end());
  v1::GivenFit& fit = *message.mutable_given();
  fit.set_status(given.status());
  fit.set_rms_m(given.rms_m());
  fit.set_peak_to_valley_m(given.peak_to_valley_m());
  fit.set_sigma_stated(given.sigma_stated());
  fit.set_normal_count(given.normal_count());
}

void GroupRecognizer::run() {
  answer.samples_refused = 0;
  recognizer_.stream_estimates(wants_estimates);
  contacts.for_each([&](const QueuedContacts& message, std::span<const ContactSample> samples,
                        std::span<const SampleDetail> details) {
    answer.samples_refused += take(message, samples, details);
  });
  contacts.clear();

  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const std::int64_t processor_start_ns = thread_processor_ns();
  if (given_class_) {
    answer_of_given_class();
  } else {
    answer_by_search();
  }
  answer.compute_ns = std::chrono::nanoseconds(Clock::now() - start).count();
  answer.processor_ns = thread_processor_ns() - processor_start_ns;

  v1::Recognition& message = answer.recognition;
  message.mutable_header()->set_frame(frame_);
  message.set_group(name_);
  message.set_object(object_);
  message.set_newest_sample_stamp_ns(newest_.sample_stamp_ns);
  message.set_newest_batch_seq(newest_.seq);
  message.set_newest_batch_epoch(newest_.epoch);
  message.set_newest_batch_source(newest_.source);
  message.set_compute_ns(answer.compute_ns);
  answer.estimates.clear();
  take_estimates();
}

void GroupRecognizer::take_estimates() {
  for (const LocalizedContact& taken : recognizer_.take_estimates()) {
    v1::LocalEstimate& estimate = answer.estimates.emplace_back();
    to_wire(taken.estimate, source_of(taken.probe, taken.patch), estimate);
    estimate.mutable_header()->set_frame(frame_);
  }
}

ContactSource GroupRecognizer::source_of(std::uint32_t probe, std::uint32_t run) const {
  if (probe >= members_.size()) return {};
  return {members_[probe].probe, members_[probe].patches.wire_patch(run).value_or(0)};
}

}  // namespace palpate
