// A place where the part was touched, on the recognised curve.
#pragma once

#include <cstdint>

#include "core/local/local_estimate.h"

namespace palpate {

/// A local estimate and its place on the recognised curve.
struct LocalizedContact {
  std::uint32_t probe = 0;
  std::uint32_t patch = 0;
  double t = 0.0;  ///< curve parameter; 0 if nothing is recognised
  LocalEstimate estimate;
};

}  // namespace palpate
