// What the recognition tree was asked on its way.
#pragma once

#include <string_view>

namespace palpate {

/// One query of the recognition tree (section 5.2).
struct Decision {
  std::string_view test;  ///< e.g. "conic line"; static storage
  double value = 0.0;
  double threshold = 0.0;
  bool passed = false;
};

}  // namespace palpate
