// Every class fitted to the reduced points: the material that evidence is weighed on.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "core/curves/curve_class.h"
#include "core/numerics/negligible.h"
#include "core/numerics/work_budget.h"
#include "core/recognition/fit/implicit_fit.h"
#include "core/recognition/fit/polynomial_fit.h"
#include "core/recognition/fit/polynomial_search.h"
#include "core/recognition/samples/fit_data.h"
#include "core/recognition/smooth/smooth_model.h"

namespace palpate {

/// A class at its best, in normalised coordinates.
struct ClassFit {
  CurveClass curve_class = CurveClass::Unclassified;
  double chi2 = 0.0;
  bool weighed = false;  ///< chi2 is that of all points, not what the reduced ones tell
  bool on_all =
      false;  ///< refined on all points; until then it has foot points of the reduced ones
  bool polished = false;  ///< at its very optimum there, and so is its rival
  /// The class has no interior optimum: chi2 is that of the neighbour it runs away to (an ellipse
  /// or hyperbola that wants to be a parabola), and there is no shape to report.
  bool at_limit = false;
  double least_chi2 = 0.0;  ///< where it is known that no curve of a class at its limit leaves less
  std::optional<ImplicitFit> implicit;      ///< line, circle, ellipse, hyperbola
  std::optional<PolynomialFit> polynomial;  ///< parabola and the cubics
  /// A spline's optimum on the other side of c = 0: where it fits as well, the shape is not known.
  std::optional<PolynomialFit> rival;
};

/// Indexed by CurveClass; entry 0 (Unclassified) is empty.
using ClassFits = std::array<std::optional<ClassFit>, 9>;

/// The implicit form of a parabola's polynomials, of unit norm.
ConicCoefficients conic_of_parabola(const PolynomialFit& fit);

/// Whether a fit to reduced points that leaves that many residuals is as good as noise allows.
inline bool fits_well(double chi2, std::size_t residuals) {
  return can_be_noise(chi2, static_cast<double>(residuals));
}

/// Sets of classes, a bit each.
constexpr unsigned class_bit(CurveClass curve_class) { return 1U << static_cast<int>(curve_class); }
inline constexpr unsigned kAllClasses = ~0U;
inline constexpr unsigned kCubics = class_bit(CurveClass::CubicalParabola) |
                                    class_bit(CurveClass::SemiCubicalParabola) |
                                    class_bit(CurveClass::CubicSpline);

struct WarmStart;

/// Fits every class to the smooth model's reduced points, taken as surface points: seeds by
/// exhaustive coarse search, or `start` where given and anything then fits;
/// least orthogonal distances, as far as telling plausible classes from others takes. What
/// `classes` leaves out may be missing. `out_of_reach`: beyond this chi-square it is not
/// asked how well a class fits. Where points are many, searches go through few of them, twice at
/// most: beside them each point costs a bounded number of steps.
/// Where `work` is spent, line and circle are there, the others as far as they have come.
ClassFits fit_classes(const FitData& reduced, WorkBudget& work, const WarmStart* start = nullptr,
                      unsigned classes = kAllClasses,
                      double out_of_reach = std::numeric_limits<double>::infinity());

}  // namespace palpate
