// An invariant in the form in which answers report it: with the paper's name, from all points
// together.
#pragma once

#include <limits>
#include <string_view>

#include "core/curves/curve_class.h"

namespace palpate {

struct NamedInvariant {
  /// The class that the invariant belongs to. Ic1 and Ic2 belong to both ellipse and hyperbola;
  /// this is the one that the sign of Ic1 indicates.
  CurveClass curve_class = CurveClass::Unclassified;
  /// Ip (19) [m^(-2/3)]; Ic1 (26) [m^(-4/3)], Ic2 (28) [m^(-2/3)]; Icp1 (39) [1/m^2], Icp2 (40);
  /// Iscp1 (43) [1/m], Iscp2 (44); a [m^(-1/2)], b, c [m^(1/2)] of the spline (45)-(50); not in the
  /// paper: kappa of the line and the circle [1/m]. Static storage.
  std::string_view name;
  double value = 0.0;
  /// Standard deviation, propagated from the estimates; infinite if unknown.
  double sigma = std::numeric_limits<double>::infinity();
};

}  // namespace palpate
