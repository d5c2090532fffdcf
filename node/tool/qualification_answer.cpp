#include "node/tool/qualification_answer.h"

#include "node/files/probe_file.h"

namespace palpate {

bool is_estimate(QualificationStatus status) {
  return status == QualificationStatus::Sufficient || status == QualificationStatus::Partial ||
         status == QualificationStatus::Insufficient;
}

v1::Probe probe_message(const Qualification& qualification, const QualificationOrigin& origin) {
  v1::Probe probe;
  probe.set_name(origin.probe);
  probe.set_artefact(origin.artefact);
  for (const std::string& file : origin.recordings) probe.add_recordings(file);
  probe.set_sample_count(qualification.samples.size());
  probe.set_verdict(qualification.status == QualificationStatus::Sufficient
                        ? v1::QUALIFICATION_VERDICT_SUFFICIENT
                    : qualification.status == QualificationStatus::Partial
                        ? v1::QUALIFICATION_VERDICT_PARTIAL
                        : v1::QUALIFICATION_VERDICT_INSUFFICIENT);
  for (const auto& [from, to] : qualification.untouched) {
    v1::ProbeDirections& directions = *probe.add_untouched();
    directions.set_from_rad(from);
    directions.set_to_rad(to);
  }
  to_wire(qualification.probe, probe);
  return probe;
}

}  // namespace palpate
