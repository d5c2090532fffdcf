// Samples that follow one another in one patch, with all that their probe says of them.
#pragma once

#include <vector>

#include "core/recognition/samples/contact_sample.h"
#include "core/recognition/samples/sample_detail.h"

namespace palpate {

struct ContactRun {
  PatchContext context;
  std::vector<ContactSample> samples;
  std::vector<SampleDetail> details = {};  ///< of the samples; empty where none says more
};

}  // namespace palpate
