// Canonical form of the general conic (10) by a rigid motion, with names for the degenerate cases;
// and the way back.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "core/curves/curve_class.h"
#include "core/curves/pose2.h"

namespace palpate {

/// q0 x^2 + q1 xy + q2 y^2 + q3 x + q4 y + q5 = 0, (10); a common factor changes nothing.
using ConicCoefficients = Eigen::Matrix<double, 6, 1>;

struct CanonicalConic {
  CurveClass curve_class = CurveClass::Unclassified;
  Eigen::Vector3d values = Eigen::Vector3d::Zero();  ///< in the order of parameter_letters
  /// The equation does not say which branch of a hyperbola is meant. This is the pose of the branch
  /// with |theta| <= pi/2; the pose of the other is turned by pi. Circles have theta = 0.
  Pose2 world_T_curve;
};

/// Why an equation is not a curve of any class.
enum class ConicDegeneracy {
  None,
  NotFinite,      ///< a coefficient, or the canonical form that it leads to, is not finite
  NoEquation,     ///< all coefficients of x and y are 0
  Imaginary,      ///< no real point
  Point,          ///< one real point
  CrossingLines,  ///< two lines that meet
  ParallelLines,  ///< two lines that do not meet
  DoubleLine,     ///< one line, counted twice
};

/// A short text: "none", "no real point", ...; static storage.
std::string_view describe(ConicDegeneracy degeneracy);

struct ConicCanonicalisation {
  std::optional<CanonicalConic> curve;  ///< none if degenerate
  ConicDegeneracy degeneracy = ConicDegeneracy::None;
};

/// Chooses the class among line, circle, ellipse, parabola and hyperbola. Three quantities count as
/// 0 up to 16 epsilon of their terms: the difference of the eigenvalues of the quadratic part (a
/// circle), the smaller eigenvalue (a parabola), and the left side at the centre (degenerate). That
/// is the rounding of coefficients to which one rigid motion has been applied. Derivation:
/// core/README.md, "Canonical forms".
ConicCanonicalisation canonicalise(const ConicCoefficients& q);

/// The canonical form for a known class, for example after a fit within that class. It applies no
/// threshold; nullopt where a sign is not the one that the class needs. Precondition: one of the
/// five classes above.
std::optional<CanonicalConic> canonicalise_as(CurveClass curve_class, const ConicCoefficients& q);

}  // namespace palpate
