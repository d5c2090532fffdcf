// A part of known shape against contact points: least orthogonal distances over its pose alone.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/part/closed_spline.h"
#include "core/part/nearest_node.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// The part in the units of normalised points, ready for foot points. These are sought on the whole
/// closed curve: points pass from segment to segment as the pose asks.
class ScaledPart {
 public:
  /// Places by which a foot point's neighbourhood is found. A segment is a cubic; between two of 48
  /// it turns by little.
  static constexpr int kNodesPerSegment = 48;

  ScaledPart(const ClosedSpline& part, double scale_m);

  const ClosedSpline& spline() const { return spline_; }
  int node_count() const { return static_cast<int>(nodes_.count()); }
  /// The curve parameter of a node (any integer; cyclic).
  static double node_t(int node) { return static_cast<double>(node) / kNodesPerSegment; }

  /// +1 where outside lies left of increasing t, -1 right: where tip centres lie.
  double outside() const { return outside_; }

  /// The global foot point's curve parameter, in [0, size()).
  double foot_of(const Vec2& part_point) const;

 private:
  ClosedSpline spline_;
  NearestNode nodes_;
  double outside_;
};

/// A point against the placed part.
struct PartFoot {
  double t = 0.0;
  double residual = 0.0;       ///< (signed distance less tip radius) in units of sigma
  Vec2 normal = Vec2::Zero();  ///< left of increasing t, unit, in the frame of the points
};

PartFoot place_on_part(const ScaledPart& part, const Pose2& data_T_part, const FitPoint& point);

/// The motions of the part that a fit may make: columns are (x, y, turn about `pivot`).
struct PartMotions {
  Vec2 pivot = Vec2::Zero();
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> columns = Eigen::Matrix3d::Identity();
};

struct PartFit {
  Pose2 data_T_part;
  double chi2 = 0.0;
  /// Fisher information of the motions at the fit.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> information;
};

/// From a start, over the motions given (2 or 3 of them). Each evaluation takes global foot points,
/// the Jacobian is that of the envelope theorem: row i = -n_i . d(part's point)/d(motion) /
/// sigma_i. O(points) per iteration.
PartFit fit_part(const ScaledPart& part, std::span<const FitPoint> points, const Pose2& start,
                 const PartMotions& motions = {}, int most_iterations = 50);

}  // namespace palpate
