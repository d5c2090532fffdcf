// A qualification: what is written and said of it.
#pragma once

#include <string>
#include <vector>

#include "core/qualification/qualify.h"
#include "palpate/v1/probe.pb.h"

namespace palpate {

/// What was done: names for the probe file and the report.
struct QualificationOrigin {
  std::string artefact;                 ///< "circle 0.0525"
  std::vector<std::string> recordings;  ///< files
  std::string probe;                    ///< the name that all samples bear, else empty
};

/// Whether there is anything to write: the samples could be laid on the artefact.
bool is_estimate(QualificationStatus status);

v1::Probe probe_message(const Qualification& qualification, const QualificationOrigin& origin);

/// For a person to read: each term with its deviation, what the samples cannot tell, the verdict.
std::string qualification_text(const Qualification& qualification,
                               const QualificationOrigin& origin);

/// Why nothing could be estimated, a sentence.
std::string why_not(QualificationStatus status);

}  // namespace palpate
