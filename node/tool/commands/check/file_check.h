// What is wrong with a file of contacts, told to whoever made it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "node/tool/commands/check/stream_check.h"
#include "node/tool/contact_groups.h"

namespace palpate {

/// What `check` says of a group of so many patches, touched at so few places that there is no
/// answer; the answer of `fit` says it itself.
std::optional<Finding> too_few_places(const ContactGroup& group, std::size_t patches);

/// Units, order, jumps, spacing, noise and stamps of one object's samples, those without a sigma
/// taken to have this one (0 = unknown). Worst first.
std::vector<Finding> check_group(const ContactGroup& group, double sigma_m = 0.0);

/// A finding as a sentence: what, and the cure.
std::string sentence_of(const Finding& finding);

}  // namespace palpate
