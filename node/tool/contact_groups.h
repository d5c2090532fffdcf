// The samples of CSV files, sorted into objects to be recognised.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/recognition/recognizer.h"
#include "core/recognition/samples/contact_run.h"
#include "node/csv/contact_table.h"

namespace palpate {

/// What is recognised together: one object under one group of one file.
struct ContactGroup {
  std::string file;
  std::string name;
  std::uint64_t object = 0;
  std::vector<std::string> probes;  ///< names, by the runs' context.probe
  std::vector<ContactRun> runs;     ///< in the order of the file
};

/// Groups in the order in which the file begins them.
std::vector<ContactGroup> contact_groups(const std::string& file, const ContactTable& table);

/// That of measured normals nothing counts and of covariances the mean noise, where there are any;
/// else nothing.
std::string note_of_unused_detail(const ContactGroup& group);

/// Feeds them all to a recogniser.
AddResult add_group(const ContactGroup& group, Recognizer& recognizer);

}  // namespace palpate
