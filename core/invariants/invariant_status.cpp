#include "core/invariants/invariant_status.h"

namespace palpate {

std::string_view describe(InvariantStatus status) {
  switch (status) {
    case InvariantStatus::Ok:
      return "ok";
    case InvariantStatus::NotFinite:
      return "not finite";
    case InvariantStatus::TooFewPoints:
      return "too few points";
    case InvariantStatus::ZeroCurvature:
      return "zero curvature";
    case InvariantStatus::SignChange:
      return "curvature changes sign";
    case InvariantStatus::PointsTooAlike:
      return "points too alike";
    case InvariantStatus::NoRealRoot:
      return "no real root";
    case InvariantStatus::NotThisClass:
      return "not this class";
    case InvariantStatus::NotConverged:
      return "not converged";
  }
  return "unknown";
}

}  // namespace palpate
