#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/recognition/samples/contact_run.h"

namespace palpate {

/// The samples that are recognised together: those of one object of one group of one file.
struct ContactGroup {
  std::string file;
  std::string name;
  std::uint64_t object = 0;
  std::vector<std::string> probes;  ///< names, indexed by context.probe of the runs
  std::vector<ContactRun> runs;     ///< in the order of the file
};

}  // namespace palpate
