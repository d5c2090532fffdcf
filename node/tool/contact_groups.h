// Sorts the samples of sample files into objects to be recognised.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/recognition/recognizer.h"
#include "core/recognition/samples/contact_run.h"
#include "node/csv/contact_table.h"

namespace palpate {

/// The samples that are recognised together: those of one object of one group of one file.
struct ContactGroup {
  std::string file;
  std::string name;
  std::uint64_t object = 0;
  std::vector<std::string> probes;  ///< names, indexed by context.probe of the runs
  std::vector<ContactRun> runs;     ///< in the order of the file
};

/// Groups in the order of their first sample in the file.
std::vector<ContactGroup> contact_groups(const std::string& file, const ContactTable& table);

/// If the samples have normals or covariances: a note that normals are not used and that only the
/// mean noise of covariances is; else empty.
std::string note_of_unused_detail(const ContactGroup& group);

/// If samples state their noise and --sigma says another: a note that theirs holds; else empty.
std::string note_of_unused_sigma(const ContactGroup& group, double sigma_m);

/// Adds all samples of the group to the recognizer.
AddResult add_group(const ContactGroup& group, Recognizer& recognizer);

}  // namespace palpate
