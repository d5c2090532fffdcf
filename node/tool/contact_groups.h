// Sorts the samples of sample files into objects to be recognised.
#pragma once

#include <string>
#include <vector>

#include "core/recognition/recognizer.h"
#include "node/check/contact_group.h"
#include "node/csv/contact_table.h"

namespace palpate {

/// Groups in the order of their first sample in the file.
std::vector<ContactGroup> contact_groups(const std::string& file, const ContactTable& table);

/// "group g, object 1: ", before what is said of one of several; empty if it `is_alone`.
std::string object_of(const ContactGroup& group, bool is_alone = false);

/// If the samples have normals or covariances: a note that normals are not used and that only the
/// mean noise of covariances is; else empty.
std::string note_of_unused_detail(const ContactGroup& group);

/// If samples state their noise and --sigma says another: a note that theirs holds; else empty.
std::string note_of_unused_sigma(const ContactGroup& group, double sigma_m);

/// Adds all samples of the group to the recognizer.
AddResult add_group(const ContactGroup& group, Recognizer& recognizer);

}  // namespace palpate
