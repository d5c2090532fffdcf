#include "core/part/part_fit.h"

#include <cassert>
#include <cmath>
#include <vector>

#include "core/curves/foot_point.h"
#include "core/numerics/least_squares.h"

namespace palpate {
namespace {

/// The pose after a motion (x, y, turn about the pivot).
Pose2 moved(const Pose2& pose, const Vec2& pivot, const Eigen::Vector3d& motion) {
  const Pose2 turn{0.0, 0.0, motion[2]};
  const Vec2 place = pivot + turn.rotate(pose.translation() - pivot) + motion.head<2>();
  return {place.x(), place.y(), wrap_angle(pose.theta + motion[2])};
}

template <int kMotions>
class PartResiduals {
 public:
  enum { NUM_PARAMETERS = kMotions };
  using Parameters = Eigen::Matrix<double, kMotions, 1>;

  PartResiduals(const ScaledPart& part, std::span<const FitPoint> points, const Pose2& start,
                const PartMotions& motions)
      : part_(part), points_(points), start_(start), motions_(motions) {}

  int NumResiduals() const { return static_cast<int>(points_.size()); }

  Pose2 pose(const Parameters& x) const {
    return moved(start_, motions_.pivot, motions_.columns * x);
  }

  bool operator()(const double* x_data, double* residuals, double* jacobian) const {
    const Parameters x = Eigen::Map<const Parameters>(x_data);
    const Eigen::Vector3d motion = motions_.columns * x;
    const Pose2 data_T_part = pose(x);
    const auto n = static_cast<Eigen::Index>(points_.size());
    for (Eigen::Index i = 0; i < n; ++i) {
      const FitPoint& point = points_[static_cast<std::size_t>(i)];
      const PartFoot foot = place_on_part(part_, data_T_part, point);
      residuals[i] = foot.residual;
      if (jacobian != nullptr) {
        const Vec2 arm = point.position - motions_.pivot - motion.head<2>();
        const Eigen::Vector3d by_motion(foot.normal.x(), foot.normal.y(),
                                        foot.normal.dot(left_of(arm)));
        const Parameters row = -point.inverse_sigma * (motions_.columns.transpose() * by_motion);
        for (int k = 0; k < kMotions; ++k) {
          jacobian[k * n + i] = row[k];
        }
      }
    }
    return true;
  }

 private:
  const ScaledPart& part_;
  std::span<const FitPoint> points_;
  Pose2 start_;
  const PartMotions& motions_;
};

template <int kMotions>
PartFit fit(const ScaledPart& part, std::span<const FitPoint> points, const Pose2& start,
            const PartMotions& motions, int most_iterations) {
  using Residuals = PartResiduals<kMotions>;
  const Residuals residuals(part, points, start, motions);
  // The last step is far shorter than this tolerance suggests, because Gauss-Newton converges
  // quadratically where the part fits.
  constexpr double kChi2Tolerance = 1e-9;
  typename Residuals::Parameters x = Residuals::Parameters::Zero();
  minimise_residuals(residuals, {most_iterations, kChi2Tolerance}, &x);
  PartFit result;
  result.data_T_part = residuals.pose(x);
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::VectorXd values(n);
  Eigen::Matrix<double, Eigen::Dynamic, kMotions> jacobian(n, kMotions);
  residuals(x.data(), values.data(), jacobian.data());
  result.chi2 = values.squaredNorm();
  result.information = jacobian.transpose() * jacobian;
  return result;
}

std::vector<Vec2> nodes_of(const ClosedSpline& part) {
  const int count = ScaledPart::kNodesPerSegment * static_cast<int>(part.size());
  std::vector<Vec2> nodes;
  nodes.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    nodes.push_back(part.position(ScaledPart::node_t(i)));
  }
  return nodes;
}

}  // namespace

ScaledPart::ScaledPart(const ClosedSpline& part, double scale_m)
    : spline_(part.scaled(1.0 / scale_m)),
      nodes_(nodes_of(spline_)),
      outside_(part.signed_area() > 0.0 ? -1.0 : 1.0) {}

double ScaledPart::foot_of(const Vec2& part_point) const {
  const auto nearest = static_cast<int>(nodes_.to(part_point));
  const double t = foot_point_near(spline_, part_point, node_t(nearest)).t;
  const ClosedSpline::Place place = spline_.place_at(t);
  return static_cast<double>(place.segment) + place.u;
}

PartFoot place_on_part(const ScaledPart& part, const Pose2& data_T_part, const FitPoint& point) {
  const Vec2 local = data_T_part.to_local(point.position);
  PartFoot foot;
  foot.t = part.foot_of(local);
  const CurveDerivatives d = part.spline().derivatives(foot.t);
  const Vec2 normal = left_of(d.first).normalized();
  const double distance = normal.dot(local - d.position);
  foot.residual = (distance - part.outside() * point.offset) * point.inverse_sigma;
  foot.normal = data_T_part.rotate(normal);
  return foot;
}

PartFit fit_part(const ScaledPart& part, std::span<const FitPoint> points, const Pose2& start,
                 const PartMotions& motions, int most_iterations) {
  assert(motions.columns.cols() == 2 || motions.columns.cols() == 3);
  return motions.columns.cols() == 2 ? fit<2>(part, points, start, motions, most_iterations)
                                     : fit<3>(part, points, start, motions, most_iterations);
}

}  // namespace palpate
