#include "sim/contact_export.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "node/wire/convert.h"
#include "node/wire/topics.h"

namespace palpate::sim {
namespace {

std::int64_t nanoseconds(double time_s) { return std::llround(time_s * 1e9); }

MaterialSide reported_side(const SimulatedPatch& patch) {
  return patch.side_is_reported ? patch.side : MaterialSide::Unspecified;
}

std::size_t intern(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    names.push_back(name);
    return names.size() - 1;
  }
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace

void append_rows(const Scene& scene, std::span<const SimulatedProbe> probes, std::uint64_t object,
                 ContactTable& table) {
  for (const SimulatedProbe& probe : probes) {
    ContactRow row;
    row.probe = intern(table.names, probe.name);
    const std::string& group = scene.description.group();
    row.group = group.empty() ? row.probe : intern(table.names, group);
    row.object = object;
    row.context.tip_radius_m = probe.tip_radius_m;
    for (const SimulatedPatch& patch : probe.patches) {
      row.context.patch = patch.number;
      row.context.material_side = reported_side(patch);
      for (const SimulatedSample& sample : patch.samples) {
        row.sample = {sample.position_m, sample.sigma_m, nanoseconds(sample.time_s)};
        row.detail = sample.detail;
        table.rows.push_back(row);
      }
    }
  }
}

std::vector<TimedBatch> make_batches(const Scene& scene, std::span<const SimulatedProbe> probes,
                                     std::uint64_t object) {
  std::vector<TimedBatch> batches;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    for (const SimulatedPatch& patch : probes[i].patches) {
      TimedBatch timed;
      timed.probe = i;
      for (std::size_t k = 0; k < patch.samples.size(); ++k) {
        const SimulatedSample& from = patch.samples[k];
        v1::ContactSample& sample = *timed.batch.add_samples();
        sample.set_stamp_ns(nanoseconds(from.time_s));
        sample.set_x_m(from.position_m.x());
        sample.set_y_m(from.position_m.y());
        sample.set_sigma_m(from.sigma_m);
        to_wire(from.detail, sample);
        const bool is_last = k + 1 == patch.samples.size();
        if (!is_last && timed.batch.samples_size() < static_cast<int>(probes[i].batch_samples)) {
          continue;
        }
        timed.time_s = from.time_s;
        timed.batch.set_group(scene.description.group());
        timed.batch.set_object(object);
        timed.batch.set_patch(patch.number);
        timed.batch.set_tip_radius_m(probes[i].tip_radius_m);
        timed.batch.set_material_side(to_wire(reported_side(patch)));
        timed.batch.mutable_header()->set_frame(scene.description.frame().empty()
                                                    ? std::string(kDefaultFrame)
                                                    : scene.description.frame());
        batches.push_back(timed);
        timed.batch.clear_samples();
      }
    }
  }
  std::stable_sort(batches.begin(), batches.end(),
                   [](const TimedBatch& a, const TimedBatch& b) { return a.time_s < b.time_s; });
  return batches;
}

}  // namespace palpate::sim
