// Reads the 50-digit reference values of tests/data/reference/curves.csv.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/curves/curve_class.h"

namespace palpate::test {

/// One point; signs are those for increasing t.
struct ReferencePoint {
  double t, x, y, tangent_angle;
  std::optional<double> slope;  ///< none if the tangent is vertical
  double kappa, kappa_s;
  std::optional<double> ip;  ///< none if kappa = 0
};

struct ReferenceCurve {
  CurveClass curve_class;
  double a, b, c;  ///< 0 if the class has no such parameter
  std::vector<ReferencePoint> points;
};

/// All curves of the file. Throws std::runtime_error if it cannot be read.
const std::vector<ReferenceCurve>& reference_curves();

}  // namespace palpate::test
