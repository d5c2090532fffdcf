// Classes whose fit runs away to a class that is their limit: what they have on their own side of
// it. Far from its vertex or inflection an arc of each of them is one of a parabola.
#pragma once

#include <array>
#include <optional>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/posterior/evidences.h"

namespace palpate {

/// A semi-cubical parabola before the spline that it is the limit of.
inline constexpr std::array kClassesWithLimit = {
    CurveClass::Ellipse, CurveClass::Hyperbola, CurveClass::CubicalParabola,
    CurveClass::SemiCubicalParabola, CurveClass::CubicSpline};

/// By so much more chi-square than its limit a class of kClassesWithLimit has not been fitted at
/// its optimum: what it has there is no more, and both are told to 1 (contenders.cpp).
inline constexpr double kWorseThanLimit = 2.0;

/// The better of a class's limits, the parabola and, of a spline, the semi-cubical parabola;
/// nullopt where neither is fitted.
std::optional<CurveClass> limit_of(CurveClass curve_class, const ClassFits& fits);

/// These classes with those that tell what they have at their limits, and in straight paths.
unsigned with_limits(unsigned classes);

/// Adds the evidence of classes at their limit, and of those whose fit double precision cannot
/// hold, where that might be seen beside `best`: at the modes that their priors lead to along the
/// limit's curve. None for a conic that the other side of the parabola tells enough of
/// (probabilities_of). `before`: as for evidences_of().
void add_limits(const ClassFits& fits, const FitData& reduced, const Likelihood& likelihood,
                double best, const Evidences& before, Evidences* evidences, WorkBudget& work);

/// log of the density that the prior of `beyond` (Ellipse or Hyperbola) has next to the parabola
/// over that of the conic `inside`, on the other side, at its mode; both by m and by slope.
double log_density_ratio_beyond(CurveClass beyond, const ClassEvidence& inside);

}  // namespace palpate
