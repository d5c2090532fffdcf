// Smooth shapes of none of the classes.
#pragma once

#include "sim/shape_point.h"

namespace palpate::sim {

/// |x / a|^n + |y / b|^n = 1 by polar angle t, n >= 2.
struct Superellipse {
  double a = 1.0;  ///< [m]
  double b = 1.0;  ///< [m]
  double exponent = 4.0;

  ShapePoint point_at(double t) const;
};

/// (t, amplitude sin(2 pi t / wavelength)), t in metres.
struct Sinusoid {
  double amplitude = 1.0;   ///< [m]
  double wavelength = 1.0;  ///< [m]

  ShapePoint point_at(double t) const;
};

/// radius exp(growth t) (cos t, sin t).
struct LogSpiral {
  double radius = 1.0;  ///< [m]
  double growth = 0.1;

  ShapePoint point_at(double t) const;
};

}  // namespace palpate::sim
