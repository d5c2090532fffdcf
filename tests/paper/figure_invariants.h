// Figures 4 and 5: three parabolas told apart by Ip, two ellipses and a circle by Ic1 and Ic2. The
// paper prints the circle's radius only; the other shapes are of the size of its others.
#pragma once

#include <array>
#include <vector>

#include "core/curves/curve.h"

namespace palpate::paper {

struct FigureCurve {
  Curve curve;
  std::array<double, 2> parameters{};  ///< a, and b of the ellipses
  std::array<double, 2> places{};      ///< parameters of the points that the values are from
  std::array<double, 2> measured{};    ///< Ip, at the first of them; or Ic1 and Ic2, from both
  std::array<double, 2> expected{};    ///< from a and b
};

/// Parabolas y^2 = 4 a x: (18) and (19).
std::vector<FigureCurve> figure4();

/// Ellipses: (26) and (28); the circle's two points have one curvature, and its values are those of
/// (24) with Ic1 = kappa^(4/3).
std::vector<FigureCurve> figure5();

}  // namespace palpate::paper
