// Appendix B: any polynomial cubic to its canonical form by a rigid motion and an affine change of
// parameter, degenerate cases included, and back. No reflection: chirality is kept.
#pragma once

#include <optional>
#include <string_view>

#include "core/curves/algebraic/polynomial_curve.h"
#include "core/curves/curve_class.h"
#include "core/curves/pose2.h"

namespace palpate {

/// t_canonical = scale * t + shift; scale < 0 where the two run in opposite directions.
struct Reparametrisation {
  double scale = 1.0;
  double shift = 0.0;

  double operator()(double t) const { return scale * t + shift; }
};

/// world_T_curve * canonical(canonical_t(t)) is the point that the polynomials had at t.
struct CanonicalCubic {
  CurveClass curve_class = CurveClass::Unclassified;
  Eigen::Vector3d values = Eigen::Vector3d::Zero();  ///< in the order of parameter_letters
  Pose2 world_T_curve;
  Reparametrisation canonical_t;
};

/// Why polynomials are no curve of a class.
enum class CubicDegeneracy {
  None,
  NotFinite,     ///< a coefficient is not finite
  OutOfRange,    ///< the canonical parameters leave the range of a double
  Point,         ///< constant
  HalfLine,      ///< a half-line covered twice, such as (t^2, 0)
  UnevenLine,    ///< a line, but with t^3 along it: no affine change of t makes that (t, 0)
  OutsideClass,  ///< the class asked for has no such curve
};

/// "none", "a constant", ...; static storage.
std::string_view describe(CubicDegeneracy degeneracy);

struct CubicCanonicalisation {
  std::optional<CanonicalCubic> curve;  ///< none where degenerate
  CubicDegeneracy degeneracy = CubicDegeneracy::None;
  /// For HalfLine: its end, x axis along it. For UnevenLine: a point of it, x axis along it with
  /// t -> infinity. For Point: the point. Else that of `curve`, if there is one.
  Pose2 world_T_curve;
};

struct CanonicalCubicOptions {
  /// A term that moves no point of [t_lower, t_upper] by more than this is taken as 0, so that the
  /// simpler class wins. [m] 0: only what the rounding of the coefficients explains, at any t.
  double distance_m = 0.0;
  double t_lower = -1.0;
  double t_upper = 1.0;
};

/// The class among line, parabola, cubical and semi-cubical parabola and cubic spline, and its
/// form. A difference of terms counts as 0 up to 16 epsilon of their sizes: the rounding of
/// coefficients which one rotation and one change of parameter have gone through. A term
/// c_3 t^3 or c_2 t^2 that is alone counts as 0 only if it is: without a range of t nothing says
/// what it may be compared with.
CubicCanonicalisation canonicalise(const PolynomialCurve2& curve,
                                   const CanonicalCubicOptions& options = {});

/// The same where the class is known (after a fit within it): terms that it has no room for are
/// left out, about t = 0 for line, parabola and cubical parabola, about the cusp for the
/// semi-cubical one. OutsideClass where what remains is not a curve of that class.
/// Precondition: one of the five classes above.
CubicCanonicalisation canonicalise_as(CurveClass curve_class, const PolynomialCurve2& curve);

/// The curve at that pose as polynomials in its canonical parameter. `values` in the order of
/// parameter_letters. Precondition: one of the five classes above.
PolynomialCurve2 polynomial_curve_of(CurveClass curve_class, const Eigen::Vector3d& values,
                                     const Pose2& world_T_curve);

}  // namespace palpate
