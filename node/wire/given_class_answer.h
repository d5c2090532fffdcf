// Fits a given class to the samples of an object and returns the answer as a message.
#pragma once

#include <cstddef>
#include <span>

#include "core/qualification/probe_character.h"
#include "core/recognition/recognizer.h"
#include "core/recognition/samples/contact_run.h"
#include "palpate/v1/given_class.pb.h"

namespace palpate {

/// `probes`: the qualified probes, indexed by the runs' probe number; empty = none. Their offsets
/// are subtracted along the normals of the fitted curve, and the covariance includes their
/// uncertainties. Runs of one patch are one stroke (joined_runs.h). `left_out`: numbers of samples
/// to leave out, each once, from 1 in the order of the runs. Of the options only sigma_m,
/// touched_from, determined_fraction and recognized_probability are used. The caller sets header,
/// group, object, newest_* and compute_ns of the recognition.
v1::GivenClassAnswer given_class_answer(CurveClass curve_class, std::span<const ContactRun> runs,
                                        std::span<const ProbeCharacter* const> probes,
                                        std::span<const std::size_t> left_out,
                                        const RecognizerOptions& options);

}  // namespace palpate
