// Consecutive samples of one patch, with all that the probe states about them.
#pragma once

#include <vector>

#include "core/recognition/samples/contact_sample.h"
#include "core/recognition/samples/sample_detail.h"

namespace palpate {

struct ContactRun {
  PatchContext context;
  std::vector<ContactSample> samples;
  std::vector<SampleDetail> details = {};  ///< one per sample; empty if no sample has one
};

}  // namespace palpate
