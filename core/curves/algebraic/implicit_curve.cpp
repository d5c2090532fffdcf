#include "core/curves/algebraic/implicit_curve.h"

#include <cmath>
#include <limits>

namespace palpate {

std::optional<LocalGeometry> implicit_geometry(const PlaneJet& jet, int degree) {
  const double g = jet.gradient.stableNorm();
  // A sum of (degree + 1)(degree + 2) / 2 terms, each of up to 2 degree + 2 roundings.
  const double roundings = 0.5 * (degree + 1) * (degree + 2) * (2 * degree + 2);
  if (!(g > roundings * std::numeric_limits<double>::epsilon() * jet.gradient_size)) {
    return std::nullopt;
  }
  // Unit tangent with the gradient on its left, and that left normal.
  const Vec2 n = jet.gradient / g;
  const Vec2 t(n.y(), -n.x());
  const double f_tt =
      jet.xx * t.x() * t.x() + 2.0 * jet.xy * t.x() * t.y() + jet.yy * t.y() * t.y();
  const double f_tn =
      jet.xx * t.x() * n.x() + jet.xy * (t.x() * n.y() + t.y() * n.x()) + jet.yy * t.y() * n.y();
  const double f_ttt = jet.xxx * t.x() * t.x() * t.x() + 3.0 * jet.xxy * t.x() * t.x() * t.y() +
                       3.0 * jet.xyy * t.x() * t.y() * t.y() + jet.yyy * t.y() * t.y() * t.y();
  LocalGeometry local;
  local.tangent_angle = std::atan2(t.y(), t.x());
  local.kappa = -f_tt / g;
  local.kappa_s = -(f_ttt + 3.0 * local.kappa * f_tn) / g;
  return is_finite(local) ? std::optional(local) : std::nullopt;
}

}  // namespace palpate
