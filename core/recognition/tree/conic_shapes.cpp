#include "core/recognition/tree/conic_shapes.h"

#include <cmath>

#include "core/invariants/conic_parameters.h"

namespace palpate {

std::vector<Eigen::Vector3d> central_shapes(CurveClass curve_class, double ic1,
                                            const ConicLine& line) {
  std::vector<Eigen::Vector3d> shapes;
  for (const double factor : {1.0, 0.3, 0.1, 3.0}) {
    const ConicParameters parameters =
        curve_class == CurveClass::Ellipse
            ? ellipse_parameters(factor * ic1, line.ic2, line.covariance)
            : hyperbola_parameters(factor * ic1, line.ic2, line.covariance);
    if (parameters.status == InvariantStatus::Ok) {
      shapes.emplace_back(parameters.a, parameters.b, 0.0);
    }
  }
  return shapes;
}

std::vector<Eigen::Vector3d> ellipses_curved_by(double kappa) {
  std::vector<Eigen::Vector3d> shapes;
  for (const double ratio : {0.9, 0.7, 0.5}) {
    const double a = ratio * std::pow(0.5 * (1.0 + ratio * ratio), -1.5) / kappa;
    shapes.emplace_back(a, ratio * a, 0.0);
  }
  return shapes;
}

std::vector<Eigen::Vector3d> parabola_shapes(const ConicLine& line) {
  const ConicParameters parameters = parabola_parameters(line.ip_mean, line.ip_variance);
  std::vector<Eigen::Vector3d> shapes;
  if (parameters.status == InvariantStatus::Ok) {
    shapes.emplace_back(parameters.a, 0.0, 0.0);
  }
  return shapes;
}

}  // namespace palpate
