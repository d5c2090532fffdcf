#include "node/tool/commands/offline/measured_group.h"

#include <cmath>
#include <string>
#include <utility>

#include "core/qualification/probe_correction.h"
#include "node/tool/commands/offline/object_answer.h"
#include "node/tool/drawing/curve_model.h"

namespace palpate {

ContactGroup as_measured(const ContactGroup& group, const std::vector<QualifiedProbe>& probes,
                         const v1::Recognition& answer, TouchedFrom touched_from) {
  ContactGroup measured = group;
  const std::optional<CurveModel> model = model_of(answer);
  if (answer.probe_files().empty() || !model) return measured;
  std::vector<std::string> files;
  std::vector<std::string> said_before;
  const std::vector<const ProbeCharacter*> characters =
      characters_of(group, probes, files, said_before);
  for (ContactRun& run : measured.runs) {
    const ProbeCharacter* probe = characters[run.context.probe];
    if (probe == nullptr) continue;
    ProbedPatch patch = as_qualified({run.context, std::move(run.samples), probe});
    patch.samples = without_offset(patch, model->curve, model->world_T_curve, touched_from);
    const double drift_m = std::hypot(probe->deviation_m.value, probe->deviation_m.deviation);
    for (ContactSample& sample : patch.samples) {
      sample.sigma_m = std::hypot(sample.sigma_m, drift_m);
    }
    run.context = patch.context;
    run.samples = std::move(patch.samples);
  }
  return measured;
}

}  // namespace palpate
