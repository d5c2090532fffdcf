// Classes, sides and places as Python names them.
#pragma once

#include <string>
#include <vector>

#include "core/curves/curve_class.h"
#include "core/recognition/samples/side_words.h"

namespace palpate {

std::vector<std::string> curve_classes();

/// Each throws std::invalid_argument that lists the known names.
CurveClass class_called(const std::string& name);
TouchedFrom place_called(const std::string& name);
MaterialSide side_called(const std::string& name);

}  // namespace palpate
