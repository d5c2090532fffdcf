// palpate fit --part: a known part placed, instead of a curve recognised.
#pragma once

#include <string>
#include <vector>

#include "core/recognition/recognizer.h"
#include "node/tool/commands/offline/fit_input.h"

namespace palpate {

/// Prints where the closed spline of this scene file lies, for each of the inputs. Returns the exit
/// code.
int place_part(const std::string& part_file, const std::vector<FitInput>& inputs,
               const RecognizerOptions& recognizer, bool json);

}  // namespace palpate
