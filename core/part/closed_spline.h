// A closed curve of cubic segments that join with two continuous derivatives: the part of section
// 6.
#pragma once

#include <optional>
#include <vector>

#include "core/curves/algebraic/canonical_cubic.h"
#include "core/curves/algebraic/polynomial_curve.h"
#include "core/curves/cubic_spline.h"
#include "core/curves/plane_curve.h"

namespace palpate {

/// The uniform periodic cubic B-spline of its control points. Segment i uses the points i to i + 3
/// (cyclic) and covers the curve parameters i to i + 1. t may be any real number; it is taken
/// modulo size().
class ClosedSpline {
 public:
  static constexpr std::size_t kFewestPoints = 4;

  /// Needs at least kFewestPoints control points. [m]
  explicit ClosedSpline(std::vector<Vec2> control_points);

  /// Number of segments; also the period of t.
  std::size_t size() const { return segments_.size(); }

  /// A place on the curve: a segment, and the parameter u in [0, 1) along it.
  struct Place {
    std::size_t segment = 0;
    double u = 0.0;
  };

  /// At a joint: the start of the segment that begins there. t must be finite.
  Place place_at(double t) const;
  std::size_t segment_at(double t) const { return place_at(t).segment; }

  /// The cubic of segment i (cyclic) as a function of u. [m]
  const PolynomialCurve2& segment(std::size_t i) const { return segments_[i % size()]; }

  Vec2 position(double t) const;
  /// The third derivative jumps at a joint; there it is that of the segment that begins.
  CurveDerivatives derivatives(double t) const;

  /// [0, size()], with period size().
  ParameterDomain domain() const;

  /// Nearest point of the whole curve, with t in [0, size()). Does not allocate.
  FootPoint foot_point(const Vec2& point) const;

  /// Signed arc length from t0 to t1, across any number of joints and turns. [m]
  double arc_length(double t0, double t1) const;
  /// The t at signed arc length s [m] from t0.
  double parameter_at_arc_length(double t0, double s) const;

  /// The curve with all lengths multiplied by `factor` > 0.
  ClosedSpline scaled(double factor) const;

  /// Enclosed area, positive if the curve runs counterclockwise (material on its left). [m^2]
  double signed_area() const;

  struct Canonical {
    CubicSpline curve;
    Pose2 shape_T_curve;
    Reparametrisation canonical_t;  ///< from u to the parameter of `curve`
  };

  /// The canonical form (38) of segment i; nullopt if the segment belongs to another class.
  std::optional<Canonical> canonical_segment(std::size_t i) const;

 private:
  std::vector<PolynomialCurve2> segments_;
};

}  // namespace palpate
