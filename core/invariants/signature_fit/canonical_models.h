// The canonical curves as templates, for automatic differentiation by shape and parameter. They
// contain only what the fits to local geometry need; the reference is core/curves/.
#pragma once

#include <array>
#include <cassert>
#include <cmath>

#include "core/curves/curve_class.h"

namespace palpate {

template <typename T>
struct PlanePoint {
  T x;
  T y;
};

/// First three derivatives of a curve by its parameter.
template <typename T>
struct ModelDerivatives {
  PlanePoint<T> first;
  PlanePoint<T> second;
  PlanePoint<T> third;
};

template <typename T>
struct ModelGeometry {
  T tangent_angle;  ///< in the canonical frame, for increasing t [rad]
  T kappa;          ///< (1)
  T kappa_s;        ///< (2)
};

template <typename T>
struct ModelCurvatures {
  T kappa;    ///< (1)
  T kappa_s;  ///< (2)
};

/// (1) and (2). Regular wherever the first derivative is not zero.
template <typename T>
ModelCurvatures<T> curvatures_of(const ModelDerivatives<T>& d) {
  using std::sqrt;
  const T speed2 = d.first.x * d.first.x + d.first.y * d.first.y;
  const T turn = d.first.x * d.second.y - d.second.x * d.first.y;
  const T turn_by_t = d.first.x * d.third.y - d.third.x * d.first.y;
  const T stretch = d.first.x * d.second.x + d.first.y * d.second.y;
  return {turn / (speed2 * sqrt(speed2)),
          (turn_by_t * speed2 - 3.0 * turn * stretch) / (speed2 * speed2 * speed2)};
}

template <typename T>
ModelGeometry<T> geometry_of(const ModelDerivatives<T>& d) {
  using std::atan2;
  const ModelCurvatures<T> curvatures = curvatures_of(d);
  return {atan2(d.first.y, d.first.x), curvatures.kappa, curvatures.kappa_s};
}

/// (a cos t, b sin t)
struct EllipseModel {
  static constexpr int kParameters = 2;

  template <typename T>
  static PlanePoint<T> position(const T* p, const T& t) {
    using std::cos;
    using std::sin;
    return {p[0] * cos(t), p[1] * sin(t)};
  }

  template <typename T>
  static ModelDerivatives<T> derivatives(const T* p, const T& t) {
    using std::cos;
    using std::sin;
    const T c = cos(t);
    const T s = sin(t);
    const T ac = p[0] * c;
    const T as = p[0] * s;
    const T bc = p[1] * c;
    const T bs = p[1] * s;
    return {{-as, bc}, {-ac, -bs}, {as, -bc}};
  }
};

/// (a cosh t, b sinh t)
struct HyperbolaModel {
  static constexpr int kParameters = 2;

  template <typename T>
  static PlanePoint<T> position(const T* p, const T& t) {
    using std::cosh;
    using std::sinh;
    return {p[0] * cosh(t), p[1] * sinh(t)};
  }

  template <typename T>
  static ModelDerivatives<T> derivatives(const T* p, const T& t) {
    using std::cosh;
    using std::sinh;
    const T c = cosh(t);
    const T s = sinh(t);
    const T ac = p[0] * c;
    const T as = p[0] * s;
    const T bc = p[1] * c;
    const T bs = p[1] * s;
    return {{as, bc}, {ac, bs}, {as, bc}};
  }
};

/// (a t^2, 2 a t)
struct ParabolaModel {
  static constexpr int kParameters = 1;

  template <typename T>
  static PlanePoint<T> position(const T* p, const T& t) {
    return {p[0] * t * t, 2.0 * p[0] * t};
  }

  template <typename T>
  static ModelDerivatives<T> derivatives(const T* p, const T& t) {
    return {{2.0 * p[0] * t, 2.0 * p[0]}, {2.0 * p[0], T(0.0)}, {T(0.0), T(0.0)}};
  }
};

/// (t, a t^3 + c t)
struct CubicalParabolaModel {
  static constexpr int kParameters = 2;

  template <typename T>
  static PlanePoint<T> position(const T* p, const T& t) {
    return {t, (p[0] * t * t + p[1]) * t};
  }

  template <typename T>
  static ModelDerivatives<T> derivatives(const T* p, const T& t) {
    return {{T(1.0), 3.0 * p[0] * t * t + p[1]}, {T(0.0), 6.0 * p[0] * t}, {T(0.0), 6.0 * p[0]}};
  }
};

/// (t^2, a t^3 + b t^2 + c t)
struct CubicSplineModel {
  static constexpr int kParameters = 3;

  template <typename T>
  static PlanePoint<T> position(const T* p, const T& t) {
    return {t * t, ((p[0] * t + p[1]) * t + p[2]) * t};
  }

  template <typename T>
  static ModelDerivatives<T> derivatives(const T* p, const T& t) {
    return {{2.0 * t, (3.0 * p[0] * t + 2.0 * p[1]) * t + p[2]},
            {T(2.0), 6.0 * p[0] * t + 2.0 * p[1]},
            {T(0.0), 6.0 * p[0]}};
  }
};

/// (t^2, a t^3 + b t^2)
struct SemiCubicalParabolaModel {
  static constexpr int kParameters = 2;

  template <typename T>
  static PlanePoint<T> position(const T* p, const T& t) {
    return {t * t, (p[0] * t + p[1]) * t * t};
  }

  template <typename T>
  static ModelDerivatives<T> derivatives(const T* p, const T& t) {
    return {{2.0 * t, (3.0 * p[0] * t + 2.0 * p[1]) * t},
            {T(2.0), 6.0 * p[0] * t + 2.0 * p[1]},
            {T(0.0), 6.0 * p[0]}};
  }
};

/// Calls `use` with the model of the class. Not for lines, circles and Unclassified.
template <typename Use>
void with_model(CurveClass curve_class, const Use& use) {
  switch (curve_class) {
    case CurveClass::Ellipse:
      return use(EllipseModel{});
    case CurveClass::Parabola:
      return use(ParabolaModel{});
    case CurveClass::Hyperbola:
      return use(HyperbolaModel{});
    case CurveClass::CubicalParabola:
      return use(CubicalParabolaModel{});
    case CurveClass::SemiCubicalParabola:
      return use(SemiCubicalParabolaModel{});
    case CurveClass::CubicSpline:
      return use(CubicSplineModel{});
    case CurveClass::Line:
    case CurveClass::Circle:
    case CurveClass::Unclassified:
      assert(false);
  }
}

}  // namespace palpate
