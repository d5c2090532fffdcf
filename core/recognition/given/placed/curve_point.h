// A point of a canonical curve with the derivatives for a second-order fit, in any arithmetic. It
// uses no transcendental function, so that it works in double-double too.
#pragma once

#include <cmath>

#include "core/curves/curve_class.h"
#include "core/numerics/double_double_math.h"

namespace palpate {

template <typename T>
struct PlaneVector {
  T x{};
  T y{};

  friend PlaneVector operator+(const PlaneVector& u, const PlaneVector& v) {
    return {u.x + v.x, u.y + v.y};
  }
  friend PlaneVector operator-(const PlaneVector& u, const PlaneVector& v) {
    return {u.x - v.x, u.y - v.y};
  }
  friend PlaneVector operator*(const T& k, const PlaneVector& v) { return {k * v.x, k * v.y}; }
};

template <typename T>
T inner(const PlaneVector<T>& u, const PlaneVector<T>& v) {
  return u.x * v.x + u.y * v.y;
}

template <typename T>
PlaneVector<T> left(const PlaneVector<T>& v) {
  return {-v.y, v.x};
}

/// Rotates `v` by the angle 2 atan(h / 2), which is h - h^3 / 12 to third order.
template <typename T>
PlaneVector<T> turned(const PlaneVector<T>& v, const T& h) {
  const T half = T(0.5) * h;
  const T square = half * half;
  const T whole = T(1.0) + square;
  const T c = (T(1.0) - square) / whole;
  const T s = (half + half) / whole;
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

/// Position and its derivatives by the curve's parameter and by the shape. The parameter is (cos t,
/// sin t) for circle and ellipse, sinh t for the hyperbola, else t.
template <typename T>
struct CurvePoint {
  PlaneVector<T> position;
  PlaneVector<T> first;
  PlaneVector<T> second;
  PlaneVector<T> by_shape[3];
  PlaneVector<T> first_by_shape[3];
};

template <typename T>
CurvePoint<T> curve_point(CurveClass curve_class, const T* shape, const PlaneVector<T>& parameter) {
  using std::sqrt;
  CurvePoint<T> p;
  const T zero(0.0);
  const T one(1.0);
  const T& a = shape[0];
  const T& t = parameter.x;
  switch (curve_class) {
    case CurveClass::Line:
      p.position = {t, zero};
      p.first = {one, zero};
      break;
    case CurveClass::Circle:
      p.position = a * parameter;
      p.first = a * left(parameter);
      p.second = -a * parameter;
      p.by_shape[0] = parameter;
      p.first_by_shape[0] = left(parameter);
      break;
    case CurveClass::Ellipse: {
      const T& b = shape[1];
      const T& c = parameter.x;
      const T& s = parameter.y;
      p.position = {a * c, b * s};
      p.first = {-a * s, b * c};
      p.second = {-a * c, -b * s};
      p.by_shape[0] = {c, zero};
      p.by_shape[1] = {zero, s};
      p.first_by_shape[0] = {-s, zero};
      p.first_by_shape[1] = {zero, c};
      break;
    }
    case CurveClass::Parabola:
      p.position = {a * t * t, (a + a) * t};
      p.first = {(a + a) * t, a + a};
      p.second = {a + a, zero};
      p.by_shape[0] = {t * t, t + t};
      p.first_by_shape[0] = {t + t, T(2.0)};
      break;
    case CurveClass::Hyperbola: {
      const T& b = shape[1];
      const T square = one + t * t;
      const T q = sqrt(square);
      p.position = {a * q, b * t};
      p.first = {a * t / q, b};
      p.second = {a / (q * square), zero};
      p.by_shape[0] = {q, zero};
      p.by_shape[1] = {zero, t};
      p.first_by_shape[0] = {t / q, zero};
      p.first_by_shape[1] = {zero, one};
      break;
    }
    case CurveClass::CubicalParabola: {
      const T& c = shape[1];
      const T t2 = t * t;
      p.position = {t, t * (a * t2 + c)};
      p.first = {one, T(3.0) * a * t2 + c};
      p.second = {zero, T(6.0) * a * t};
      p.by_shape[0] = {zero, t2 * t};
      p.by_shape[1] = {zero, t};
      p.first_by_shape[0] = {zero, T(3.0) * t2};
      p.first_by_shape[1] = {zero, one};
      break;
    }
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline: {
      const bool spline = curve_class == CurveClass::CubicSpline;
      const T& b = shape[1];
      const T c = spline ? shape[2] : zero;
      const T t2 = t * t;
      p.position = {t2, t * (a * t2 + b * t + c)};
      p.first = {t + t, T(3.0) * a * t2 + (b + b) * t + c};
      p.second = {T(2.0), T(6.0) * a * t + b + b};
      p.by_shape[0] = {zero, t2 * t};
      p.by_shape[1] = {zero, t2};
      p.by_shape[2] = {zero, t};
      p.first_by_shape[0] = {zero, T(3.0) * t2};
      p.first_by_shape[1] = {zero, t + t};
      p.first_by_shape[2] = {zero, one};
      break;
    }
    case CurveClass::Unclassified:
      break;
  }
  return p;
}

}  // namespace palpate
