// Contact samples as they stand in a CSV file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/recognition/samples/contact_sample.h"
#include "core/recognition/samples/sample_detail.h"

namespace palpate {

/// One sample with all that its line says. Names are indices into ContactTable::names.
struct ContactRow {
  std::size_t probe = 0;
  std::size_t group = 0;  ///< the probe's own name where the file gives none
  std::uint64_t object = 0;
  PatchContext context;  ///< context.probe is not used
  ContactSample sample;
  SampleDetail detail = {};
};

struct ContactTable {
  std::vector<std::string> names;  ///< each once
  std::vector<ContactRow> rows;    ///< in the order of the file
};

}  // namespace palpate
