// A pose as Python gets it.
#pragma once

#include <pybind11/pybind11.h>

#include "core/curves/pose2.h"

namespace palpate {

/// (x, y, theta).
inline pybind11::tuple pose_of(const Pose2& pose) {
  return pybind11::make_tuple(pose.x, pose.y, pose.theta);
}

}  // namespace palpate
