#include "core/qualification/estimated_tip.h"

#include <cmath>

namespace palpate {

ProbeCharacter with_estimated_tip(ProbeCharacter probe) {
  // The thinnest tips that are sold are 0.1 mm across. A smaller constant is rather an error of a
  // radius that was taken off before. [m]
  constexpr double kThinnest = 5e-5;
  constexpr double kSure = 5.0;  // deviations
  NormalOffset& offset = probe.offset;
  const double constant_m = offset.coefficients_m[0];
  const double lobes_m = offset.coefficients_m.tail(offset.coefficients_m.size() - 1).norm();
  const double deviation_m = std::hypot(std::sqrt(offset.covariance_m2(0, 0)), probe.setup_m.value,
                                        probe.setup_m.deviation);
  const bool is_tip = !(probe.tip_radius_m > 0.0) && constant_m >= kThinnest &&
                      constant_m > lobes_m + kSure * deviation_m;
  if (is_tip) {
    probe.tip_radius_m = constant_m;
    offset.coefficients_m[0] = 0.0;
  }
  return probe;
}

}  // namespace palpate
