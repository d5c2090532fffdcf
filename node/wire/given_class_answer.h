// A class that is given: samples of an object in, the answer's message out.
#pragma once

#include <cstddef>
#include <span>

#include "core/qualification/probe_character.h"
#include "core/recognition/recognizer.h"
#include "core/recognition/samples/contact_run.h"
#include "palpate/v1/given_class.pb.h"

namespace palpate {

/// By qualified probes where there are any (`probes`: by the runs' probe number; empty = none):
/// their offsets are taken off by the normals of the curve fitted, and the covariance holds what
/// they leave open. `left_out`: numbers of samples, from 1 in the order of the runs. Of the options
/// the noise and the fraction within which a parameter counts as determined. The recognition's
/// header, group, object, newest_* and compute_ns are left to the caller.
v1::GivenClassAnswer given_class_answer(CurveClass curve_class, std::span<const ContactRun> runs,
                                        std::span<const ProbeCharacter* const> probes,
                                        std::span<const std::size_t> left_out,
                                        const RecognizerOptions& options);

}  // namespace palpate
