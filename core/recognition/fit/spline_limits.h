// A cubic spline and what it is at its limits: each may start from the others.
#pragma once

#include <algorithm>
#include <array>

#include "core/curves/curve_class.h"
#include "core/numerics/work_budget.h"
#include "core/recognition/fit/polynomial_fits.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// The classes that a spline is one of at its limits.
inline constexpr std::array kLimitsOfSpline = {
    CurveClass::CubicalParabola, CurveClass::SemiCubicalParabola, CurveClass::Parabola};

inline bool is_limit_of_spline(CurveClass curve_class) {
  return std::find(kLimitsOfSpline.begin(), kLimitsOfSpline.end(), curve_class) !=
         kLimitsOfSpline.end();
}

/// A class can be no worse than its limits: the spline starts from them too where it is. Limits
/// above `highest_chi2` do not matter. `out_of_reach`: as fit_classes.
void start_spline_from_limits(const FitData& reduced, double highest_chi2, double out_of_reach,
                              PolynomialFits* fits, WorkBudget& work);

/// Nor need a limit be worse than what the class has come to: the valleys of a cusp are narrow, and
/// the spline, which has one coefficient more, may be through where its limit is not.
void start_semi_cubical_from_spline(const FitData& reduced, double out_of_reach,
                                    PolynomialFits* fits, WorkBudget& work);

/// The semi-cubical parabola next to a spline, refined from there.
PolynomialFit semi_cubical_from(const PolynomialFit& spline, const FitData& reduced,
                                double out_of_reach, WorkBudget& work);

/// The same of the cubical parabola, of a spline whose vertex is far away: next to it, and along
/// its axis.
void start_cubical_from_spline(const FitData& reduced, double out_of_reach, PolynomialFits* fits,
                               WorkBudget& work);

}  // namespace palpate
