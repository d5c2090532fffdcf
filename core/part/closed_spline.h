// A closed curve of C2-joined cubic segments: the part of section 6.
#pragma once

#include <optional>
#include <vector>

#include "core/curves/algebraic/canonical_cubic.h"
#include "core/curves/algebraic/polynomial_curve.h"
#include "core/curves/cubic_spline.h"
#include "core/curves/plane_curve.h"

namespace palpate {

/// The uniform periodic cubic B-spline of its control points: segment i uses points i to i + 3
/// (cyclic) and runs over the curve parameters i to i + 1. Any real t is taken modulo the count.
class ClosedSpline {
 public:
  static constexpr std::size_t kFewestPoints = 4;

  /// At least kFewestPoints of them. [m]
  explicit ClosedSpline(std::vector<Vec2> control_points);

  /// Number of segments, the period of t.
  std::size_t size() const { return segments_.size(); }

  /// A place by segment and the parameter u in [0, 1) along it.
  struct Place {
    std::size_t segment = 0;
    double u = 0.0;
  };

  /// At a joint the segment that begins there. t must be finite.
  Place place_at(double t) const;
  std::size_t segment_at(double t) const { return place_at(t).segment; }

  /// The cubic of a segment (cyclic) over u. [m]
  const PolynomialCurve2& segment(std::size_t i) const { return segments_[i % size()]; }

  Vec2 position(double t) const;
  /// The third derivative jumps at the joints: there, that of the segment that begins.
  CurveDerivatives derivatives(double t) const;

  /// [0, size()], closed.
  ParameterDomain domain() const;

  /// Nearest point of the whole curve, t in [0, size()). No allocation.
  FootPoint foot_point(const Vec2& point) const;

  /// Signed arc length from t0 to t1, over as many joints and turns as lie between. [m]
  double arc_length(double t0, double t1) const;
  /// The t at signed arc length s from t0.
  double parameter_at_arc_length(double t0, double s) const;

  /// All lengths multiplied by factor > 0.
  ClosedSpline scaled(double factor) const;

  /// Area inside, positive where the curve runs counterclockwise (material on its left). [m^2]
  double signed_area() const;

  struct Canonical {
    CubicSpline curve;
    Pose2 shape_T_curve;
    Reparametrisation canonical_t;  ///< of u
  };

  /// The segment in canonical form (38); nullopt where it is of another class.
  std::optional<Canonical> canonical_segment(std::size_t i) const;

 private:
  std::vector<PolynomialCurve2> segments_;
};

}  // namespace palpate
