#include "core/recognition/estimate_stream.h"

#include <algorithm>

#include "core/local/tip_radius.h"
#include "core/recognition/samples/sample_faults.h"
#include "core/recognition/samples/tips/tip_sides.h"

namespace palpate {

void EstimateStream::add(const PatchContext& context, std::span<const ContactSample> samples,
                         std::span<const SampleDetail> details) {
  if (fault_of_all(context, samples, details) != SampleFault::None) {
    return;
  }
  auto probe = std::find_if(probes_.begin(), probes_.end(), [&](const Probe& known) {
    return known.context.probe == context.probe;
  });
  if (probe == probes_.end()) {
    probes_.push_back({context, SlidingWindow(options_)});
    probe = probes_.end() - 1;
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const ContactSample& sample = samples[i];
    if (fault_of(i, samples, details) != SampleFault::None) {
      continue;
    }
    const bool goes_on = probe->window.count() > 0 && is_of_one_stroke(probe->context, context);
    if (goes_on && sample.position_m == probe->newest_m) {
      continue;
    }
    if (!goes_on) {
      probe->window.reset();
    }
    probe->context = goes_on ? continued(probe->context, context) : context;
    probe->newest_m = sample.position_m;
    if (const auto estimate = probe->window.add(sample.position_m, sample.sigma_m);
        estimate && estimate->result) {
      probe->waiting.push_back({probe->context, estimate->result.estimate});
      if (probe->waiting.size() > kMostWaiting) {
        probe->waiting.pop_front();
      }
    }
  }
}

std::vector<LocalizedContact> EstimateStream::take(const SideOf& side_of) {
  std::vector<LocalizedContact> taken;
  for (Probe& probe : probes_) {
    while (!probe.waiting.empty()) {
      const Waiting& next = probe.waiting.front();
      int side = 0;
      if (next.context.tip_radius_m > 0.0) {
        side = stated_side(next.context.material_side);
        side = side != 0 ? side : side_of(next.context.probe, next.context.patch);
        if (side == 0) {
          break;
        }
      }
      if (const auto surface = surface_from_tip(next.estimate, side * next.context.tip_radius_m)) {
        taken.push_back({next.context.probe, next.context.patch, 0.0, *surface});
      }
      probe.waiting.pop_front();
    }
  }
  return taken;
}

}  // namespace palpate
