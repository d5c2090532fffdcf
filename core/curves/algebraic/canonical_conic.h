// The general conic (10) to its canonical form by a rigid motion, degenerate cases named, and back.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "core/curves/curve_class.h"
#include "core/curves/pose2.h"

namespace palpate {

/// q0 x^2 + q1 xy + q2 y^2 + q3 x + q4 y + q5 = 0, (10); any common factor.
using ConicCoefficients = Eigen::Matrix<double, 6, 1>;

struct CanonicalConic {
  CurveClass curve_class = CurveClass::Unclassified;
  Eigen::Vector3d values = Eigen::Vector3d::Zero();  ///< in the order of parameter_letters
  /// The equation does not say which branch of a hyperbola is meant: this is the one with
  /// |theta| <= pi/2, the other has its pose turned by pi. Circles have theta = 0.
  Pose2 world_T_curve;
};

/// Why an equation is no curve of a class.
enum class ConicDegeneracy {
  None,
  NotFinite,      ///< a coefficient is not finite
  NoEquation,     ///< no x and no y in it
  Imaginary,      ///< no real point
  Point,          ///< one real point
  CrossingLines,  ///< two lines that meet
  ParallelLines,  ///< two lines that do not
  DoubleLine,     ///< one line, twice
};

/// "none", "no real point", ...; static storage.
std::string_view describe(ConicDegeneracy degeneracy);

struct ConicCanonicalisation {
  std::optional<CanonicalConic> curve;  ///< none where degenerate
  ConicDegeneracy degeneracy = ConicDegeneracy::None;
};

/// The class among line, circle, ellipse, parabola and hyperbola. Two semi-axes count as equal, an
/// eigenvalue of the quadratic part as 0 and the left side at the centre as 0 up to 16 epsilon of
/// the terms that they are made of: the rounding of coefficients which one rigid motion has gone
/// through. Derivation: core/README.md, "Conics".
ConicCanonicalisation canonicalise(const ConicCoefficients& q);

/// The same where the class is known (after a fit within it): no threshold but the sign that the
/// class demands; nullopt where it is not met. Precondition: one of the five classes above.
std::optional<CanonicalConic> canonicalise_as(CurveClass curve_class, const ConicCoefficients& q);

/// The equation of the curve at that pose, of unit norm; of a hyperbola both branches satisfy it.
/// Precondition: one of the five classes above, `values` in the order of parameter_letters.
ConicCoefficients conic_of(CurveClass curve_class, const Eigen::Vector3d& values,
                           const Pose2& world_T_curve);

}  // namespace palpate
