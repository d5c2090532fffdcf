// The sender of a message and its rights.
#pragma once

#include <string_view>

#include "node/wire/curve_keys.h"

namespace palpate {

/// The sender of a message.
struct Sender {
  std::string_view key;                ///< Z85; empty without CURVE
  const ProbeNames* probes = nullptr;  ///< names it may publish under; nullptr = any

  bool may_publish_as(std::string_view probe) const {
    return probes == nullptr || probes->contains(probe);
  }
};

}  // namespace palpate
