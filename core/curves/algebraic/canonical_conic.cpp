#include "core/curves/algebraic/canonical_conic.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/numerics/double_double.h"

namespace palpate {
namespace {

/// A coefficient after one rotation and one translation has an error of up to 16 * 2^-53 of its
/// terms' sizes, and two such coefficients occur in a term.
constexpr double kConicRounding = 16.0 * std::numeric_limits<double>::epsilon();

/// The equation in the axes of its quadratic part:
/// large u^2 + small v^2 + linear_u u + linear_v v + constant = 0.
struct PrincipalForm {
  Vec2 axis;  ///< of u; v is to its left
  double large = 0.0;
  double small = 0.0;
  double linear_u = 0.0;
  double linear_v = 0.0;
  double constant = 0.0;

  explicit PrincipalForm(const ConicCoefficients& q) : constant(q[5]) {
    const double half_trace = 0.5 * (q[0] + q[2]);
    const double radius = std::hypot(0.5 * (q[0] - q[2]), 0.5 * q[1]);
    large = half_trace + std::copysign(radius, half_trace);
    // The smaller eigenvalue from the determinant: half_trace - radius would cancel.
    small = large != 0.0 ? difference_of_products(q[0], q[2], 0.5 * q[1], 0.5 * q[1]) / large : 0.0;
    const double angle =
        0.5 * std::atan2(q[1], q[0] - q[2]) + (half_trace >= 0.0 ? 0.0 : 0.5 * kPi);
    axis = {std::cos(angle), std::sin(angle)};
    linear_u = q[3] * axis.x() + q[4] * axis.y();
    linear_v = cross(axis, Vec2(q[3], q[4]));
  }

  bool is_parabolic() const { return std::abs(small) <= kConicRounding * std::abs(large); }

  /// The left side where u is -linear_u / (2 large), without the terms in v.
  double constant_at_u0() const { return constant - 0.25 * linear_u * (linear_u / large); }

  /// The left side at the centre. `size`: the sum of the absolute values of its terms.
  double at_centre(double* size) const {
    const double u_term = 0.25 * linear_u * (linear_u / large);
    const double v_term = 0.25 * linear_v * (linear_v / small);
    *size = std::abs(constant) + std::abs(u_term) + std::abs(v_term);
    return static_cast<double>(DoubleDouble(constant) + DoubleDouble(-u_term) +
                               DoubleDouble(-v_term));
  }

  Vec2 world(double u, double v) const { return u * axis + v * left_of(axis); }
};

/// Of two poses that differ by half a turn and are equivalent, the one nearer to the world's axes.
Pose2 nearer_half(Pose2 pose) {
  if (std::abs(pose.theta) > 0.5 * kPi) {
    pose.theta = wrap_angle(pose.theta + kPi);
  }
  return pose;
}

std::optional<CanonicalConic> finished(const CanonicalConic& curve, int parameters) {
  const Pose2& pose = curve.world_T_curve;
  const bool good = curve.values.allFinite() &&
                    (curve.values.head(parameters).array() > 0.0).all() && std::isfinite(pose.x) &&
                    std::isfinite(pose.y) && std::isfinite(pose.theta);
  return good ? std::optional(curve) : std::nullopt;
}

std::optional<CanonicalConic> as_line(const ConicCoefficients& q) {
  const Vec2 normal(q[3], q[4]);
  const double norm = normal.stableNorm();
  if (!(norm > 0.0)) {
    return std::nullopt;
  }
  // The origin is the point of the line nearest to the world's origin.
  const Vec2 unit = normal / norm;
  return finished({CurveClass::Line, Eigen::Vector3d::Zero(),
                   nearer_half(pose_along(-q[5] / norm * unit, -left_of(unit)))},
                  0);
}

std::optional<CanonicalConic> as_circle(const ConicCoefficients& q) {
  const double quadratic = 0.5 * (q[0] + q[2]);
  const Vec2 centre = Vec2(q[3], q[4]) / (-2.0 * quadratic);
  const double square = centre.squaredNorm() - q[5] / quadratic;
  return finished(
      {CurveClass::Circle, {std::sqrt(square), 0.0, 0.0}, {centre.x(), centre.y(), 0.0}}, 1);
}

std::optional<CanonicalConic> as_parabola(const PrincipalForm& form) {
  // large (u - u0)^2 = -linear_v (v - v0): opens along v where linear_v and large differ in sign.
  const double u0 = -0.5 * form.linear_u / form.large;
  const double v0 = -form.constant_at_u0() / form.linear_v;
  const double opening = -form.linear_v / form.large;
  const Vec2 x_axis = std::copysign(1.0, opening) * left_of(form.axis);
  return finished({CurveClass::Parabola,
                   {0.25 * std::abs(opening), 0.0, 0.0},
                   pose_along(form.world(u0, v0), x_axis)},
                  1);
}

std::optional<CanonicalConic> as_central(CurveClass curve_class, const PrincipalForm& form) {
  double size = 0.0;
  const double at_centre = form.at_centre(&size);
  const double square_u = -at_centre / form.large;
  const double square_v = -at_centre / form.small;
  // The major axis of an ellipse belongs to the smaller eigenvalue, the real axis of a hyperbola to
  // the positive square.
  const bool along_u = curve_class == CurveClass::Hyperbola && square_u > 0.0;
  const double sign = curve_class == CurveClass::Hyperbola ? -1.0 : 1.0;
  const double a2 = along_u ? square_u : square_v;
  const double b2 = sign * (along_u ? square_v : square_u);
  const Vec2 centre =
      form.world(-0.5 * form.linear_u / form.large, -0.5 * form.linear_v / form.small);
  return finished({curve_class,
                   {std::sqrt(a2), std::sqrt(b2), 0.0},
                   nearer_half(pose_along(centre, along_u ? form.axis : left_of(form.axis)))},
                  2);
}

ConicCanonicalisation degenerate(ConicDegeneracy degeneracy) { return {std::nullopt, degeneracy}; }

ConicCanonicalisation in_range(const std::optional<CanonicalConic>& curve) {
  return curve ? ConicCanonicalisation{curve, ConicDegeneracy::None}
               : degenerate(ConicDegeneracy::NotFinite);
}

/// The quadratic part is a square: a parabola, or lines across u.
ConicCanonicalisation parabolic(const PrincipalForm& form) {
  const double u_term = 0.25 * form.linear_u * (form.linear_u / form.large);
  const double size = std::abs(form.constant) + std::abs(u_term);
  // linear_v counts if it exceeds the rounding of the linear part, which was rotated as a whole.
  if (std::abs(form.linear_v) >
          kConicRounding * (std::abs(form.linear_u) + std::abs(form.linear_v)) &&
      form.linear_v != 0.0) {
    return in_range(as_parabola(form));
  }
  const double rest = form.constant_at_u0();
  if (std::abs(rest) <= kConicRounding * size) {
    return degenerate(ConicDegeneracy::DoubleLine);
  }
  return degenerate(rest / form.large < 0.0 ? ConicDegeneracy::ParallelLines
                                            : ConicDegeneracy::Imaginary);
}

}  // namespace

std::string_view describe(ConicDegeneracy degeneracy) {
  switch (degeneracy) {
    case ConicDegeneracy::None:
      return "none";
    case ConicDegeneracy::NotFinite:
      return "not finite";
    case ConicDegeneracy::NoEquation:
      return "no x and no y in it";
    case ConicDegeneracy::Imaginary:
      return "no real point";
    case ConicDegeneracy::Point:
      return "one point";
    case ConicDegeneracy::CrossingLines:
      return "two lines that meet";
    case ConicDegeneracy::ParallelLines:
      return "two parallel lines";
    case ConicDegeneracy::DoubleLine:
      return "a line, twice";
  }
  return "";
}

ConicCanonicalisation canonicalise(const ConicCoefficients& coefficients) {
  if (!coefficients.allFinite()) {
    return degenerate(ConicDegeneracy::NotFinite);
  }
  if (coefficients.head<5>().isZero(0.0)) {
    return degenerate(ConicDegeneracy::NoEquation);
  }
  // Scaled, so that products of coefficients do not overflow or underflow.
  const ConicCoefficients q = coefficients / coefficients.head<5>().cwiseAbs().maxCoeff();
  if (q.head<3>().isZero(0.0)) {
    return in_range(as_line(q));
  }
  const PrincipalForm form(q);
  if (form.is_parabolic()) {
    return parabolic(form);
  }
  double size = 0.0;
  const double at_centre = form.at_centre(&size);
  const bool elliptic = form.small / form.large > 0.0;
  if (std::abs(at_centre) <= kConicRounding * size) {
    return degenerate(elliptic ? ConicDegeneracy::Point : ConicDegeneracy::CrossingLines);
  }
  if (!elliptic) {
    return in_range(as_central(CurveClass::Hyperbola, form));
  }
  if (at_centre / form.large > 0.0) {
    return degenerate(ConicDegeneracy::Imaginary);
  }
  const bool round = std::abs(form.large - form.small) <= kConicRounding * std::abs(form.large);
  return in_range(round ? as_circle(q) : as_central(CurveClass::Ellipse, form));
}

std::optional<CanonicalConic> canonicalise_as(CurveClass curve_class, const ConicCoefficients& q) {
  switch (curve_class) {
    case CurveClass::Line:
      return as_line(q);
    case CurveClass::Circle:
      return as_circle(q);
    case CurveClass::Parabola:
      return as_parabola(PrincipalForm(q));
    case CurveClass::Ellipse:
    case CurveClass::Hyperbola:
      return as_central(curve_class, PrincipalForm(q));
    default:
      assert(false);
      return std::nullopt;
  }
}

}  // namespace palpate
