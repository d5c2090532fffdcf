// Whether strokes may begin with the approach to the part and end with the retract from it, told to
// whoever took the samples.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "node/check/contact_group.h"
#include "node/check/patch_check.h"

namespace palpate {

/// Which strokes have straight ends (straight_ends.h), and the --leave-out that sets these aside.
/// Samples are numbered as there: from 1 in the group's order. `left_out`: numbers of those that
/// are set aside already. `is_alone`: a file has no other group or object, else --leave-out does
/// not do.
std::optional<Finding> judge_approaches(const ContactGroup& group, bool is_alone,
                                        std::span<const std::size_t> left_out = {},
                                        CheckedSource source = CheckedSource::File);

}  // namespace palpate
