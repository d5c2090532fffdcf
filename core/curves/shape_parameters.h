// The shape parameters of a curve, and the covariance of shape and pose.
#pragma once

#include <Eigen/Core>

#include "core/curves/curve_class.h"

namespace palpate {

/// Shape parameters in the order of parameter_letters(class); unused entries are 0.
struct ShapeParameters {
  CurveClass curve_class = CurveClass::Unclassified;
  Eigen::Vector3d values = Eigen::Vector3d::Zero();
};

/// Covariance of [shape parameters; x; y; theta]; at most 6 x 6, no heap allocation.
using ShapePoseCovariance = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

}  // namespace palpate
