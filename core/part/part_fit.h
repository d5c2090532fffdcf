// Fits the pose of a part of known shape to contact points, by least orthogonal distances.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/part/closed_spline.h"
#include "core/part/nearest_node.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// The part in the units of the normalised points, with fast foot points. Foot points are searched
/// on the whole closed curve, so a point may change its segment as the pose changes.
class ScaledPart {
 public:
  /// Nodes from which a foot point is searched. A segment is a cubic; it turns little between two
  /// of 48 nodes.
  static constexpr int kNodesPerSegment = 48;

  ScaledPart(const ClosedSpline& part, double scale_m);

  const ClosedSpline& spline() const { return spline_; }
  int node_count() const { return static_cast<int>(nodes_.count()); }
  /// The curve parameter of a node; any integer, cyclic.
  static double node_t(int node) { return static_cast<double>(node) / kNodesPerSegment; }

  /// The side of the outside, where tip centres lie: +1 left of increasing t, -1 right.
  double outside() const { return outside_; }

  /// Curve parameter of the nearest point of the whole curve, in [0, size()). `part_point` is in
  /// the frame and the units of this part.
  double foot_of(const Vec2& part_point) const;

 private:
  ClosedSpline spline_;
  NearestNode nodes_;
  double outside_;
};

/// The foot of a point on the placed part.
struct PartFoot {
  double t = 0.0;
  double residual = 0.0;       ///< (signed distance - tip offset) / sigma
  Vec2 normal = Vec2::Zero();  ///< unit normal, left of increasing t, in the frame of the points
};

PartFoot place_on_part(const ScaledPart& part, const Pose2& data_T_part, const FitPoint& point);

/// The motions that a fit may use. The columns are combinations of (x, y, turn about `pivot`).
struct PartMotions {
  Vec2 pivot = Vec2::Zero();
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> columns = Eigen::Matrix3d::Identity();
};

struct PartFit {
  Pose2 data_T_part;
  double chi2 = 0.0;
  /// Fisher information of these motions at the fit.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> information;
};

/// Fits the pose from `start`, over 2 or 3 motions. Every evaluation computes the nearest points of
/// the whole curve. The Jacobian follows from the envelope theorem: row i = -n_i . d(part's
/// point)/d(motion) / sigma_i. O(points) per iteration.
PartFit fit_part(const ScaledPart& part, std::span<const FitPoint> points, const Pose2& start,
                 const PartMotions& motions = {}, int most_iterations = 50);

}  // namespace palpate
