#include "core/numerics/probability/student_quantile.h"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numbers>

namespace palpate {

double student_quantile(double z, double dof) {
  const double beyond = 0.5 * std::erfc(z / std::numbers::sqrt2);
  return quantile(complement(boost::math::students_t(dof), beyond));
}

}  // namespace palpate
