// What is wrong with the normals that a probe measures, told to its author.
#pragma once

#include <string>
#include <vector>

#include "node/check/patch_check.h"

namespace palpate {

/// Beside the direction of travel and the side on which the material is stated to lie; nothing
/// where no normal was measured.
void judge_normals(const std::string& probe, const std::vector<CheckedPatch>& patches,
                   std::vector<Finding>* findings);

}  // namespace palpate
