// The recogniser's answer for one object of a file.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "core/recognition/recognizer.h"
#include "node/files/probe_files.h"
#include "node/tool/commands/offline/fit_input.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

struct Answered {
  Recognition recognition;
  v1::Recognition wire;
};

/// What the object alone says: file, group, number, newest stamp, and how long it took.
void fill_origin(const ContactGroup& group, std::chrono::steady_clock::duration taken,
                 v1::Recognition& answer);

/// What the probes of an object are, by their number; none where `probes` is empty. `files`
/// receives those that count, `notes` what is to be said of them.
std::vector<const ProbeCharacter*> characters_of(const ContactGroup& group,
                                                 const ProbeFiles& probes,
                                                 std::vector<std::string>& files,
                                                 std::vector<std::string>& notes);

/// By qualified probes where there are any (core/qualification/probed_recognition.h). `notes`
/// receives what is to be said beside the answer.
Answered recognise(const FitInput& input, const RecognizerOptions& options,
                   const ProbeFiles& probes, std::vector<std::string>& notes);

}  // namespace palpate
