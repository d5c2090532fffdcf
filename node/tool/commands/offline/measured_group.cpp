#include "node/tool/commands/offline/measured_group.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/qualification/probe_correction.h"
#include "core/recognition/samples/joined_runs.h"
#include "node/tool/commands/offline/object_answer.h"
#include "node/tool/drawing/curve_model.h"

namespace palpate {

ContactGroup as_measured(const ContactGroup& group, const ProbeFiles& probes,
                         const v1::Recognition& answer, TouchedFrom touched_from) {
  ContactGroup measured = group;
  const std::optional<CurveModel> model = model_of(answer);
  if (answer.probe_files().empty() || !model) return measured;
  std::vector<std::string> files;
  std::vector<std::string> said_before;
  const std::vector<const ProbeCharacter*> characters =
      characters_of(group, probes, files, said_before);
  // The side of the material may be told by the direction of travel, which is a whole stroke's.
  JoinedRuns joined = joined_runs(measured.runs);
  std::vector<ContactSample> all;
  for (ContactRun& run : joined.runs) {
    if (const ProbeCharacter* probe = characters[run.context.probe]) {
      ProbedPatch patch = as_qualified({run.context, std::move(run.samples), probe});
      run.samples = without_offset(patch, model->curve, model->world_T_curve, touched_from);
      const double drift_m = std::hypot(probe->deviation_m.value, probe->deviation_m.deviation);
      for (ContactSample& sample : run.samples) {
        sample.sigma_m = std::hypot(sample.sigma_m, drift_m);
      }
    }
    all.insert(all.end(), run.samples.begin(), run.samples.end());
  }
  std::size_t number = 0;
  for (ContactRun& run : measured.runs) {
    const ProbeCharacter* probe = characters[run.context.probe];
    if (probe != nullptr) run.context = as_qualified({run.context, {}, probe}).context;
    for (ContactSample& sample : run.samples) sample = all[joined.place_of[number++]];
  }
  return measured;
}

}  // namespace palpate
