#include "core/recognition/smooth/path_of_details.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/probability/negligible.h"

namespace palpate {
namespace {

/// The highest degree whose direction noise does not turn; 0 = it turns that of a line as well. At
/// its ends a polynomial of degree d turns within 1 / d^2 of its chord (A. A. Markov, 1889), and
/// samples are moved, and weighed, by its direction (across_noise.h). Over a length l an error e of
/// the slope comes back as
///   12 (c_along - c_across) / l^2 e,
/// with the noise's variances c, and the most of it that lies one way is less than their sum. So
/// over as many deviations as nothing errs by less than 12 / 25 of it comes back, and directions
/// settle.
int told_degree(const SectionFit& fit, const FitData& data) {
  double longest = 0.0;  // variance
  for (std::size_t i = fit.section.begin; i < fit.section.end; ++i) {
    const Eigen::Vector3d& covariance = data.details[i].covariance;
    longest = std::max(longest, covariance.x() + covariance.z());
  }
  const double shortest = kNegligibleDeviations * std::sqrt(longest);
  const double told = std::sqrt(2.0 * fit.frame.half_length / shortest);
  return told < fit.degree ? static_cast<int>(told) : fit.degree;
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
