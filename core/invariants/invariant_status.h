// Why an invariant has a value, or has none.
#pragma once

#include <string_view>

namespace palpate {

enum class InvariantStatus {
  Ok,
  NotFinite,       ///< an input or the value itself is not finite
  TooFewPoints,    ///< fewer points than unknowns
  ZeroCurvature,   ///< kappa = 0 where the invariant divides by it: an inflection or a line
  SignChange,      ///< kappa changes sign within a patch, which it does on no conic
  PointsTooAlike,  ///< the points carry the same information, so the value is undetermined
  NoRealRoot,      ///< the equations of the class have no real solution for these points
  /// There is a solution, but its values lie outside the class (for example a^2 < 0).
  NotThisClass,
  NotConverged,  ///< the iteration did not reach a minimum
};

/// A short text: "ok", "not finite", ...; static storage.
std::string_view describe(InvariantStatus status);

}  // namespace palpate
