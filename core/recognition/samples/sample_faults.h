// Why samples cannot be used: one place for all who take them.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include "core/recognition/samples/contact_sample.h"
#include "core/recognition/samples/sample_detail.h"

namespace palpate {

enum class SampleFault { None, TipRadius, Detail, NotFinite, NegativeSigma };

/// Of all samples of one call: a tip radius that is negative or not finite, or another number of
/// details than of samples (none at all is good).
inline SampleFault fault_of_all(const PatchContext& context, std::span<const ContactSample> samples,
                                std::span<const SampleDetail> details) {
  if (!(context.tip_radius_m >= 0.0) || !std::isfinite(context.tip_radius_m)) {
    return SampleFault::TipRadius;
  }
  return details.empty() || details.size() == samples.size() ? SampleFault::None
                                                             : SampleFault::Detail;
}

/// Of one sample, and of its detail if there are any.
inline SampleFault fault_of(std::size_t i, std::span<const ContactSample> samples,
                            std::span<const SampleDetail> details) {
  const ContactSample& sample = samples[i];
  if (!sample.position_m.allFinite() || !std::isfinite(sample.sigma_m)) {
    return SampleFault::NotFinite;
  }
  if (sample.sigma_m < 0.0) {
    return SampleFault::NegativeSigma;
  }
  return details.empty() || is_sound(details[i]) ? SampleFault::None : SampleFault::Detail;
}

}  // namespace palpate
