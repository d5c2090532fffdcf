#include "core/recognition/verdict/determined.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

/// Natural size of the k-th shape parameter, to which its standard deviation is compared.
double natural_size(const ShapeParameters& shape, Eigen::Index k, double extent_m) {
  const char letter = parameter_letters(shape.curve_class)[static_cast<std::size_t>(k)];
  const double size = std::abs(shape.values[k]);
  if (shape.curve_class == CurveClass::CubicSpline && letter == 'c') {
    return std::max(size, std::sqrt(extent_m));  // c t against x = t^2
  }
  if (degrees_of_freedom(shape.curve_class) >= 5 && letter != 'a' &&
      shape.curve_class != CurveClass::Ellipse && shape.curve_class != CurveClass::Hyperbola) {
    return std::max(size, 1.0);  // slopes
  }
  return size;
}

Eigen::Index letters_of(CurveClass curve_class) {
  return static_cast<Eigen::Index>(parameter_letters(curve_class).size());
}

}  // namespace

bool is_determined(const ShapeParameters& shape, const ShapePoseCovariance& covariance,
                   double extent_m, double fraction) {
  for (Eigen::Index k = 0; k < letters_of(shape.curve_class); ++k) {
    if (!(std::sqrt(covariance(k, k)) <= fraction * natural_size(shape, k, extent_m))) {
      return false;
    }
  }
  return true;
}

}  // namespace palpate
