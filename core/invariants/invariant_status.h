// Why an invariant has, or has not, a value.
#pragma once

#include <string_view>

namespace palpate {

enum class InvariantStatus {
  Ok,
  NotFinite,       ///< an input, or the value itself, is not a finite number
  TooFewPoints,    ///< fewer points than unknowns
  ZeroCurvature,   ///< kappa = 0 where the invariant divides by it: an inflection or a line
  SignChange,      ///< kappa changes sign within a patch: no conic does that
  PointsTooAlike,  ///< the points carry the same information: the value is undetermined
  NoRealRoot,      ///< the class's equations have no real solution for these points
  NotThisClass,    ///< solved, but the values lie outside the class (e.g. a^2 < 0)
  NotConverged,    ///< the iteration did not reach a minimum
};

/// "ok", "not finite", ...; static storage.
std::string_view describe(InvariantStatus status);

}  // namespace palpate
