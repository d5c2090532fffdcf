// The fit of a given class as text for a person to read.
#pragma once

#include <string>

#include "palpate/v1/given_class.pb.h"

namespace palpate {

/// Several lines, each ending with a line feed.
std::string given_class_text(const v1::GivenClassAnswer& answer);

}  // namespace palpate
