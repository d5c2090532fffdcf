// Fits of every class to the reduced points; the posterior compares them.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>

#include "core/curves/algebraic/polynomial_curve.h"
#include "core/curves/curve_class.h"
#include "core/numerics/probability/negligible.h"
#include "core/numerics/work_budget.h"
#include "core/recognition/fit/orthogonal/implicit_fit.h"
#include "core/recognition/fit/orthogonal/polynomial_fit.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// The best fit of a class, in normalised coordinates.
struct ClassFit {
  CurveClass curve_class = CurveClass::Unclassified;
  double chi2 = 0.0;
  bool chi2_of_all = false;  ///< computed on all points, not inferred from the reduced points
  /// Refined on all points. Until then its foot points are those of the reduced points.
  bool on_all = false;
  /// At its exact optimum on all points, and so is its rival; without one, chi2 is infinite.
  bool polished = false;
  /// The class has no interior optimum: chi2 is that of the neighbouring class to which the fit
  /// runs (e.g. the best ellipse or hyperbola is a parabola). There is no shape to report.
  bool at_limit = false;
  std::optional<ImplicitFit> implicit;      ///< line, circle, ellipse, hyperbola
  std::optional<PolynomialFit> polynomial;  ///< parabola and the cubics
  /// A spline's optimum on the other side of c = 0; of few touches, the second best of all. If it
  /// fits as well, the shape is not known. As a search leaves it, a semi-cubical parabola's that
  /// opens the other way (weigh/probable_cusp.h).
  std::optional<PolynomialFit> rival;
  /// The surface points that the fit is of, where tips were taken off along the class's own
  /// directions; nullptr: those that all classes share.
  std::shared_ptr<const FitData> own_points = nullptr;
};

/// The reduced points that a class is fitted to.
inline const FitData& points_of(const ClassFit& fit, const FitData& shared) {
  return fit.own_points != nullptr ? *fit.own_points : shared;
}

/// Indexed by CurveClass; entry 0 (Unclassified) is empty.
using ClassFits = ByClass<std::optional<ClassFit>>;

/// The implicit form of a parabola's polynomials, of unit norm.
ConicCoefficients conic_of_parabola(const PolynomialFit& fit);

/// The foot of a point of those that the fit is of.
inline Vec2 foot_of(const ClassFit& fit, std::size_t point) {
  return fit.polynomial ? position_at(fit.polynomial->coefficients, fit.polynomial->t[point])
                        : fit.implicit->feet[point];
}

/// True if noise alone can leave this chi-square on reduced points with that many residuals.
inline bool fits_well(double chi2, std::size_t residuals) {
  return can_be_noise(chi2, static_cast<double>(residuals));
}

/// Sets of classes, one bit per class.
constexpr unsigned class_bit(CurveClass curve_class) { return 1U << static_cast<int>(curve_class); }
inline constexpr unsigned kAllClasses = ~0U;
inline constexpr unsigned kCubics = class_bit(CurveClass::CubicalParabola) |
                                    class_bit(CurveClass::SemiCubicalParabola) |
                                    class_bit(CurveClass::CubicSpline);

/// As what a point is counted whose foot is sought anywhere on a canonical curve: on a cubic it is
/// one of the roots of a polynomial.
constexpr WorkKind kind_of_foot(CurveClass curve_class) {
  return (class_bit(curve_class) & kCubics) != 0 ? WorkKind::SoughtFoot : WorkKind::PlacedRow;
}

struct WarmStart;

/// Fits every class to the smooth model's reduced points, taken as surface points, by least
/// orthogonal distances. The fits are accurate enough to decide which classes stay in the running.
/// They start from `start` if one is given and anything then fits, else from an exhaustive coarse
/// search. Classes not in `classes` may be missing. A fit whose chi-square is above `out_of_reach`
/// is not refined. If there are many points, the searches use only a few of them, in at most two
/// rounds; apart from that each point costs a bounded number of steps.
ClassFits fit_classes(const FitData& reduced, WorkBudget& work, const WarmStart* start = nullptr,
                      unsigned classes = kAllClasses,
                      double out_of_reach = std::numeric_limits<double>::infinity());

}  // namespace palpate
