// Who sent a message, and what that one may do.
#pragma once

#include <string_view>

#include "node/wire/curve_keys.h"

namespace palpate {

/// Who sent a message, as far as it matters.
struct Sender {
  std::string_view key;                ///< Z85; empty without CURVE
  const ProbeNames* probes = nullptr;  ///< as which it may publish; nullptr = any

  bool may_publish_as(std::string_view probe) const {
    return probes == nullptr || probes->contains(probe);
  }
};

}  // namespace palpate
