// Whether a round tip's stated radius can be that of the probe, told to its author.
#pragma once

#include <string>
#include <vector>

#include "node/check/patch_check.h"

namespace palpate {

/// Of each object's patches together: single touches have no extent of their own.
void judge_tips(const std::string& probe, const std::vector<CheckedPatch>& patches,
                CheckedSource source, std::vector<Finding>* findings);

}  // namespace palpate
