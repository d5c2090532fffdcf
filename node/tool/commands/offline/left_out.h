// --leave-out: samples of a file that are not to count.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "node/files/result.h"
#include "node/tool/contact_groups.h"

namespace palpate {

/// The samples that words such as "3" and "20-25" name, by their number in the group from 1.
Result<std::vector<std::size_t>> left_out_of(const std::vector<std::string>& words,
                                             const ContactGroup& group);

/// The group without these samples.
ContactGroup without_samples(const ContactGroup& group, std::span<const std::size_t> left_out);

}  // namespace palpate
