#include "node/tool/commands/offline/fit_answer.h"

#include <algorithm>
#include <utility>

#include "core/recognition/samples/work_limit.h"
#include "node/check/approach_check.h"
#include "node/check/group_check.h"
#include "node/files/counted.h"
#include "node/tool/commands/command.h"
#include "node/tool/commands/offline/answer_notes.h"
#include "node/tool/commands/offline/given_answer.h"
#include "node/tool/commands/offline/left_out.h"
#include "node/tool/commands/offline/measured_group.h"
#include "node/tool/text/given_class_text.h"
#include "node/tool/text/message_json.h"
#include "node/tool/text/report.h"

namespace palpate {
namespace {

bool noise_is_known(const FitInput& input, const RecognizerOptions& options,
                    const v1::Recognition& answer) {
  return input.noise_is_known || options.sigma_m > 0.0 || answer.probe_files_size() > 0;
}

void add_recognised(const FitRequest& fit, const FitInput& input, const ProbeFiles& probes,
                    bool json, FitAnswer* told) {
  RecognizerOptions options = fit.recognizer;
  const bool patches_are_bounded =
      std::find(fit.said.begin(), fit.said.end(), "most_patches") != fit.said.end();
  options.patience = kPatienceWithFiles;
  options.memory = memory_for(input.group, options.memory, patches_are_bounded);
  Answered answered = recognise(input, options, probes, told->notes);
  told->answer = std::move(answered.wire);
  told->spikes_m = answered.recognition.outliers_m;
  told->recognition = std::move(answered.recognition);
  told->text = json ? json_line(told->answer)
                    : report_text(told->answer, noise_is_known(input, options, told->answer));
}

void add_given(const FitRequest& fit, const FitInput& input, const ProbeFiles& probes,
               const std::vector<std::size_t>& left_out, bool json, FitAnswer* told) {
  told->notes = input.notes;
  const v1::GivenClassAnswer given = fit_given({*curve_class_from_name(fit.given_class), left_out},
                                               input.group, fit.recognizer, probes, told->notes);
  told->text = json ? json_line(given) : given_class_text(given);
  told->answer = given.recognition();
}

}  // namespace

FitAnswer fit_answer(const FitRequest& fit, FitInput input, const ProbeFiles& probes,
                     const std::vector<std::size_t>& left_out, bool json) {
  // By the numbers that the samples have in the file, so before any is left out.
  const std::optional<Finding> approach = judge_approaches(input.group, input.is_alone, left_out);
  FitAnswer told;
  if (fit.given_class.empty()) {
    if (!left_out.empty()) {
      input.group = without_samples(input.group, left_out);
      input.notes.push_back("left out: " + counted(left_out.size(), "sample") + " (--leave-out)");
    }
    add_recognised(fit, input, probes, json, &told);
  } else {
    add_given(fit, input, probes, left_out, json, &told);
  }
  const TouchedFrom from = fit.recognizer.touched_from;
  told.measured = as_measured(input.group, probes, told.answer, from);
  told.stated =
      stated_of(told.measured, fit.recognizer, noise_is_known(input, fit.recognizer, told.answer));
  told.is_found = told.answer.status() == v1::RECOGNITION_STATUS_RECOGNIZED &&
                  told.answer.curve_class() != v1::CURVE_CLASS_UNCLASSIFIED;
  const auto say = [&](std::string note) {
    if (note.empty()) return;
    complain(input.group.file + ": " + object_of(input.group, input.is_alone) + note, kDone);
    told.notes.push_back(std::move(note));
  };
  say(note_of_tip_side(told.measured, told.answer, from));
  if (probes.all().empty()) {  // else a probe file may know the tip
    say(note_of_unused_side(input.group, from));
  }
  // A class that is given is fitted to all samples: none is set aside as a spike.
  if (approach && (!told.is_found || !fit.given_class.empty())) {
    say("WARNING: " + sentence_of(*approach));
  }
  return told;
}

}  // namespace palpate
