// A closed curve of C2-joined cubic segments, as the closed spline part of section 6.
#pragma once

#include <optional>
#include <vector>

#include "core/curves/cubic_spline.h"
#include "sim/shape_point.h"

namespace palpate::sim {

/// The uniform periodic cubic B-spline of its control points: segment i uses points i to i + 3
/// (cyclic) and runs over the curve parameters i to i + 1. Any real t is taken modulo the count.
class ClosedSpline {
 public:
  /// At least four points.
  explicit ClosedSpline(std::vector<Vec2> control_points);

  /// Number of segments, the period of t.
  std::size_t size() const { return points_.size(); }

  /// The segment at t; at a joint the one that begins there.
  std::size_t segment_at(double t) const;

  ShapePoint point_at(double t) const;

  struct Canonical {
    CubicSpline curve;
    Pose2 shape_T_curve;
  };

  /// The segment in canonical form (38); nullopt where its cubic or its quadratic part vanishes, or
  /// they are parallel: then it is of another class.
  std::optional<Canonical> canonical_segment(std::size_t segment) const;

 private:
  /// Coefficients of u^3, u^2, u, 1 over a segment, u in [0, 1].
  struct Cubic {
    Vec2 third, second, first, zeroth;
  };
  Cubic cubic(std::size_t segment) const;

  std::vector<Vec2> points_;
};

}  // namespace palpate::sim
