// Points of space brought into a plane.
#pragma once

#include <string>
#include <vector>

#include "core/curves/pose2.h"
#include "node/csv/contact_file.h"

namespace palpate::csv {

struct PlanePoints {
  std::vector<Vec2> points;
  std::string note;   ///< which plane, and what was dropped
  std::string error;  ///< why there is none; else empty
};

/// Metres in and out. The fitted plane's axes: those of xy, xz or yz, whichever is nearest, turned
/// into it, so that left and right are the same; the origin at the foot of the world's origin.
PlanePoints in_plane(const std::vector<Eigen::Vector3d>& points, PointPlane plane);

}  // namespace palpate::csv
