// Appendix B: canonical form of a curve whose coordinates are cubic polynomials, by a rigid motion
// and an affine change of parameter, with names for the degenerate cases; and the way back. There
// is no reflection: chirality is kept.
#pragma once

#include <optional>
#include <string_view>

#include "core/curves/algebraic/polynomial_curve.h"
#include "core/curves/curve_class.h"
#include "core/curves/pose2.h"

namespace palpate {

/// t_canonical = scale * t + shift; scale < 0 if the two parameters run in opposite directions.
struct Reparametrisation {
  double scale = 1.0;
  double shift = 0.0;

  double operator()(double t) const { return scale * t + shift; }
};

/// The point of the polynomials at t is world_T_curve * canonical(canonical_t(t)).
struct CanonicalCubic {
  CurveClass curve_class = CurveClass::Unclassified;
  Eigen::Vector3d values = Eigen::Vector3d::Zero();  ///< in the order of parameter_letters
  Pose2 world_T_curve;
  Reparametrisation canonical_t;
};

/// Why the polynomials are not a curve of any class.
enum class CubicDegeneracy {
  None,
  NotFinite,     ///< a coefficient is not finite
  OutOfRange,    ///< the canonical parameters leave the range of a double
  Point,         ///< a constant
  HalfLine,      ///< a half-line, covered twice, such as (t^2, 0)
  UnevenLine,    ///< a line with t^3 along it: no affine change of t makes it (t, 0)
  OutsideClass,  ///< the requested class has no such curve
};

/// A short text: "none", "a point", ...; static storage.
std::string_view describe(CubicDegeneracy degeneracy);

struct CubicCanonicalisation {
  std::optional<CanonicalCubic> curve;  ///< none if degenerate
  CubicDegeneracy degeneracy = CubicDegeneracy::None;
  /// For HalfLine: its end, x axis along the line. For UnevenLine: a point of the line, x axis
  /// along it towards t -> infinity. For Point: the point. Otherwise the pose of `curve`, if there
  /// is one.
  Pose2 world_T_curve;
};

struct CanonicalCubicOptions {
  /// A term counts as 0, so that the simpler class wins, if it moves no point of [t_lower, t_upper]
  /// by more than this. 0: only what the rounding of the coefficients explains, at any t. [m]
  double distance_m = 0.0;
  double t_lower = -1.0;
  double t_upper = 1.0;
};

/// Chooses the class among line, parabola, cubical parabola, semi-cubical parabola and cubic
/// spline, and computes the canonical form. A difference of terms counts as 0 up to 16 epsilon of
/// their sizes: the rounding of coefficients to which one rotation and one change of parameter have
/// been applied. A single term c_3 t^3 or c_2 t^2 counts as 0 only if it is exactly 0: without a
/// range of t there is nothing to compare it with.
CubicCanonicalisation canonicalise(const PolynomialCurve2& curve,
                                   const CanonicalCubicOptions& options = {});

/// The canonical form for a known class, for example after a fit within that class. Terms that the
/// class does not have are dropped: about t = 0 for line, parabola and cubical parabola, about the
/// cusp for the semi-cubical one. OutsideClass if the rest is not a curve of that class.
/// Precondition: one of the five classes above.
CubicCanonicalisation canonicalise_as(CurveClass curve_class, const PolynomialCurve2& curve);

}  // namespace palpate
