// A canonical curve at a pose, with a foot point for each fitted point: the state of the fit.
#pragma once

#include <cstddef>
#include <vector>

#include "core/curves/curve_class.h"
#include "core/recognition/given/placed/curve_point.h"

namespace palpate {

inline constexpr int kMostUnknowns = 6;  ///< three of the shape, three of the pose

/// Index of each unknown of a class: shape, then x and y of the pose, then the angle. -1 if left
/// out: x of a line, which slides freely, and the angle of a circle.
struct Unknowns {
  explicit Unknowns(CurveClass curve_class)
      : shape(static_cast<int>(parameter_letters(curve_class).size())),
        x(curve_class == CurveClass::Line ? -1 : shape),
        y(curve_class == CurveClass::Line ? 0 : shape + 1),
        angle(curve_class == CurveClass::Circle ? -1 : y + 1),
        count(curve_class == CurveClass::Circle ? y + 1 : y + 2) {}

  int shape;
  int x;
  int y;
  int angle;
  int count;
};

template <typename T>
struct PlacedCurve {
  CurveClass curve_class = CurveClass::Unclassified;
  T shape[3] = {};
  PlaneVector<T> origin;                  ///< of the curve, in the points' frame
  PlaneVector<T> axis{T(1.0), T(0.0)};    ///< the curve's x axis there, unit
  std::vector<PlaneVector<T>> feet = {};  ///< parameter of every point's foot point

  PlaneVector<T> to_curve(const PlaneVector<T>& point) const {
    const PlaneVector<T> d = point - origin;
    return {inner(axis, d), inner(left(axis), d)};
  }

  /// Moves the curve by a step of the unknowns. The step of the pose is in the curve's own frame.
  void move(const T* step) {
    using std::sqrt;
    const Unknowns unknowns(curve_class);
    for (int i = 0; i < unknowns.shape; ++i) {
      shape[i] = shape[i] + step[i];
    }
    const PlaneVector<T> across = left(axis);
    if (unknowns.x >= 0) {
      origin = origin + step[unknowns.x] * axis;
    }
    origin = origin + step[unknowns.y] * across;
    if (unknowns.angle >= 0) {
      axis = turned(axis, step[unknowns.angle]);
      axis = T(1.0) / sqrt(inner(axis, axis)) * axis;
    }
    if (curve_class == CurveClass::Ellipse && to_double(shape[0]) < to_double(shape[1])) {
      const T a = shape[0];
      shape[0] = shape[1];
      shape[1] = a;
      axis = left(axis);
      for (PlaneVector<T>& foot : feet) {
        foot = {foot.y, -foot.x};
      }
    }
  }
};

/// Converts to another arithmetic.
template <typename To, typename From>
PlaneVector<To> as(const PlaneVector<From>& v) {
  return {To(v.x), To(v.y)};
}

template <typename T>
PlaneVector<double> as_double(const PlaneVector<T>& v) {
  return {to_double(v.x), to_double(v.y)};
}

}  // namespace palpate
