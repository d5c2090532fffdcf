#include "core/recognition/smooth/path_of_details.h"

#include <cmath>

namespace palpate {
namespace {

/// How much longer the noise is one way than the other: the difference of its two variances.
double unevenness(const Eigen::Vector3d& covariance) {
  return std::hypot(covariance.x() - covariance.z(), 2.0 * covariance.y());
}

/// The highest degree whose direction noise does not turn; 0 = it turns that of a line as well.
/// Samples are moved along the path, and weighed, by its direction (across_noise.h). If that errs
/// by e, their noise along the path still has e (c_along - c_across) in common with what lies
/// across, with the noise's variances c, and a polynomial takes it up. Of e = P_d'(x) / h, P_d
/// Legendre's polynomial over a half length h, it comes back as
///   integral P_d'^2 / integral P_d^2 (c_along - c_across) / h^2 e
///     = d (d + 1) (2 d + 1) / 2 (c_along - c_across) / h^2 e.
/// Where less than half of it does, directions settle.
int told_degree(const SectionFit& fit, const FitData& data) {
  double sum = 0.0;
  double weights = 0.0;
  for (std::size_t i = fit.section.begin; i < fit.section.end; ++i) {
    const double inverse = data.points[i].inverse_sigma;
    sum += inverse * inverse * unevenness(data.details[i].covariance);
    weights += inverse * inverse;
  }
  const double square = fit.frame.half_length * fit.frame.half_length;
  int told = 0;
  while (told < fit.degree && (told + 1) * (told + 2) * (2 * told + 3) * sum < square * weights) {
    ++told;
  }
  return told;
}

}  // namespace

void tell_path(const SectionFit& fit, FitData* data) {
  const int told = told_degree(fit, *data);
  for (std::size_t i = fit.section.begin; i < fit.section.end; ++i) {
    PointDetail& detail = data->details[i];
    const FitPoint& point = data->points[i];
    const double x = fit.frame.along(point.position);
    const auto path = fit.polynomials.evaluate(x, fit.degree);
    detail.off_path = fit.distance(point, path);
    detail.travel =
        told > 0 ? fit.frame.tangent(fit.polynomials.evaluate(x, told).derivative) : Vec2::Zero();
  }
}

}  // namespace palpate
