// The results of a probe qualification, as a probe file and as text.
#pragma once

#include <string>
#include <vector>

#include "core/qualification/qualify.h"
#include "palpate/v1/probe.pb.h"

namespace palpate {

/// Names for the probe file and the report.
struct QualificationOrigin {
  std::string artefact;                 ///< e.g. "circle 0.0525"
  std::vector<std::string> recordings;  ///< files
  std::string probe;  ///< the name of the probe if all samples have the same, else empty
};

/// True if there is something to write: the artefact could be fitted to the samples.
bool is_estimate(QualificationStatus status);

v1::Probe probe_message(const Qualification& qualification, const QualificationOrigin& origin);

/// A text for a person to read: each term with its standard deviation, what the samples do not
/// determine, and the verdict.
std::string qualification_text(const Qualification& qualification,
                               const QualificationOrigin& origin);

/// The sentence that says why nothing could be estimated.
std::string why_not(QualificationStatus status);

}  // namespace palpate
