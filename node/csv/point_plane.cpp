#include "node/csv/point_plane.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace palpate::csv {
namespace {

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

std::string millimetres(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g mm", 1e3 * metres);
  return text;
}

/// The axes of xy, xz or yz.
struct NamedPlane {
  Eigen::Index first;
  Eigen::Index second;

  std::string name() const {
    return std::string(kAxes[static_cast<std::size_t>(first)]) +
           kAxes[static_cast<std::size_t>(second)];
  }
};

NamedPlane plane_without(Eigen::Index dropped) {
  return {dropped == 0 ? 1 : 0, dropped == 2 ? 1 : 2};
}

PlanePoints without_axis(const std::vector<Eigen::Vector3d>& points, Eigen::Index dropped,
                         double spread_m) {
  const NamedPlane plane = plane_without(dropped);
  PlanePoints result;
  for (const Eigen::Vector3d& point : points) {
    result.points.emplace_back(point[plane.first], point[plane.second]);
  }
  result.note = "the plane is " + plane.name() + "; " + kAxes[static_cast<std::size_t>(dropped)] +
                " is dropped: it varies by " + millimetres(spread_m);
  return result;
}

PlanePoints fitted(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) mean += point / static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    spread += (point - mean) * (point - mean).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  // Points on one line lie in many planes.
  constexpr double kFlattest = 1e-12;  // of the squared spread along the line
  if (!(axes.eigenvalues()[1] > kFlattest * axes.eigenvalues()[2])) {
    PlanePoints none;
    none.error =
        "the points lie on one line of space: no plane can be fitted; choose one (xy, xz, yz)";
    return none;
  }
  Eigen::Vector3d normal = axes.eigenvectors().col(0);
  Eigen::Index largest = 0;
  normal.cwiseAbs().maxCoeff(&largest);
  // Seen from the side from which the nearest of xy, xz and yz is seen: left of the travel
  // (material_side) is the same in both. xz is seen from below its third axis: x cross z is -y.
  const NamedPlane nearest = plane_without(largest);
  const Eigen::Vector3d first = Eigen::Vector3d::Unit(nearest.first);
  if (normal.dot(first.cross(Eigen::Vector3d::Unit(nearest.second))) < 0.0) normal = -normal;
  const Eigen::Vector3d u = (first - normal.dot(first) * normal).normalized();
  const Eigen::Vector3d v = normal.cross(u);
  PlanePoints result;
  for (const Eigen::Vector3d& point : points)
    result.points.emplace_back(point.dot(u), point.dot(v));
  const double rms =
      std::sqrt(std::max(axes.eigenvalues()[0], 0.0) / static_cast<double>(points.size()));
  char text[256];
  std::snprintf(
      text, sizeof text,
      "the plane is fitted, nearest to %s: normal (%.6f, %.6f, %.6f), x axis (%.6f, %.6f, "
      "%.6f), at %s along its normal; the points lie off it by %s rms, which is dropped",
      nearest.name().c_str(), normal.x(), normal.y(), normal.z(), u.x(), u.y(), u.z(),
      millimetres(mean.dot(normal)).c_str(), millimetres(rms).c_str());
  result.note = text;
  return result;
}

}  // namespace

PlanePoints in_plane(const std::vector<Eigen::Vector3d>& points, PointPlane plane) {
  if (plane == PointPlane::Fitted) return fitted(points);
  Eigen::Vector3d low = points.front();
  Eigen::Vector3d high = low;
  for (const Eigen::Vector3d& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const Eigen::Vector3d spread = high - low;
  if (plane != PointPlane::Varying) {
    const Eigen::Index dropped = plane == PointPlane::Xy ? 2 : plane == PointPlane::Xz ? 1 : 0;
    return without_axis(points, dropped, spread[dropped]);
  }
  // Of equal spreads the last: points on a line along x lie in xy.
  Eigen::Index least = 2;
  for (const Eigen::Index axis : {1, 0}) {
    if (spread[axis] < spread[least]) least = axis;
  }
  // A machine that holds an axis still moves it by its noise and the part's tilt: 0.6 degrees here.
  constexpr double kHeldStill = 0.01;  // of the largest spread
  if (spread[least] <= kHeldStill * spread.maxCoeff()) {
    return without_axis(points, least, spread[least]);
  }
  PlanePoints none;
  none.error = "the points vary along x, y and z (by " + millimetres(spread.x()) + ", " +
               millimetres(spread.y()) + ", " + millimetres(spread.z()) +
               "): choose their plane, --plane xy, xz, yz or fit";
  return none;
}

}  // namespace palpate::csv
