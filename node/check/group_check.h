// What is wrong with the samples of one object that are there at once: a file's, or arrays.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "node/check/contact_group.h"
#include "node/check/patch_check.h"

namespace palpate {

/// What `check` says of a group of so many patches, touched at so few places that there is no
/// answer; the answer of `fit` says it itself.
std::optional<Finding> too_few_places(const ContactGroup& group, std::size_t patches);

/// Units, order, jumps, spacing, noise and stamps of one object's samples, those without a sigma
/// taken to have this one (0 = unknown). Worst first.
std::vector<Finding> check_group(const ContactGroup& group, double sigma_m = 0.0,
                                 CheckedSource source = CheckedSource::File);

/// Whose a finding is, before it: "group g, object 1: probe: "; empty if all samples'.
std::string whose(const Finding& finding);

/// A finding as a sentence: what, and the cure.
std::string sentence_of(const Finding& finding);

}  // namespace palpate
