#include "core/recognition/posterior/likelihood_of.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/numerics/probability/chi_square.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/posterior/runs_along.h"
#include "core/recognition/smooth/residual_correlation.h"
#include "core/recognition/smooth/stated_form_error.h"

namespace palpate {

namespace {

/// With the noise integrated out, prior 1 / sigma, parameters have Student's law. Where that has no
/// variance: the square of its 97.5 % point over the normal law's.
double variance_of_student(double dof) {
  constexpr double kOfOne = 42.03;  // (12.706 / 1.95996)^2
  constexpr double kOfTwo = 4.819;  // (4.3027 / 1.95996)^2
  return dof > 2.0 ? dof / (dof - 2.0) : dof > 1.0 ? kOfTwo : kOfOne;
}

/// Whether neighbours along the class's curve err together.
ResidualCorrelation correlation_along(const CanonicalFit& placed, const FitData& data) {
  std::vector<double> residuals;
  residuals.reserve(placed.points.size());
  const Runs runs = runs_along(placed, data.patches);
  FitData in_order;
  in_order.patches = runs.spans;
  for (const std::size_t i : runs.order) {
    in_order.points.push_back(data.points[i]);
    residuals.push_back(placed.points[i].residual);
  }
  return correlation_of(in_order, residuals);
}

/// Whether a stated noise covers residuals of that variance of which the sections show only a part:
/// the rest is what neighbours share, so that sections follow it.
bool is_stated(const Arcs& arcs, double variance) {
  return arcs.sigma_known && variance <= 1.0 &&
         leaves_less_than_noise(arcs.smooth.chi2, arcs.smooth.dof());
}

}  // namespace

// Touches that lie too far apart to show their noise leave the class alone to tell it.
bool noise_is_known_without_class(const Arcs& arcs, const Likelihood& likelihood) {
  return likelihood.sigma_known || arcs.smooth.dof() >= kDegreesThatShowNoise;
}

Likelihood likelihood_of(const Arcs& arcs, double form_deviation_m) {
  const double n = static_cast<double>(arcs.data.points.size());
  Likelihood likelihood;
  likelihood.sigma_known = arcs.sigma_known;
  // Of neighbours that err together each tells so much less of what the path does slowly.
  likelihood.tempering = arcs.smooth.noise_time;
  likelihood.samples = n / likelihood.tempering;
  // Residuals below any probe's noise, or the rounding of the coordinates, say nothing.
  const double least = std::max(rounding_level(arcs.data), kFinest) / arcs.sigma;
  likelihood.chi2_floor = arcs.sigma_known ? 0.0 : likelihood.samples * least * least;
  likelihood.coherent_variance =
      coherent_variance(arcs.data, form_deviation_m / arcs.data.scale) / likelihood.tempering;
  likelihood.noise_chi2 = arcs.smooth.chi2;
  return likelihood;
}

ResidualExcess residual_excess(const Arcs& arcs, const Likelihood& likelihood, double chi2,
                               const CanonicalFit& placed, bool unclassified) {
  const SmoothModel& smooth = arcs.smooth;
  const double n = static_cast<double>(residual_count(arcs.data));
  const int parameters = degrees_of_freedom(placed.shape.curve_class);
  const double dof = n - parameters;
  const double variance = chi2 / dof;  // of the residuals, in units of sigma^2
  const double noise = smooth.dof() > 0 ? smooth.chi2 / smooth.dof() : 1.0;
  const double excess = arcs.sigma * std::sqrt(std::max(0.0, variance - noise));
  // What is no noise, neighbours do not share either.
  const bool are_noise = likelihood.sigma_known || chi2 > likelihood.chi2_floor;
  const ResidualCorrelation correlation =
      are_noise ? correlation_along(placed, arcs.data) : ResidualCorrelation{};
  // Where the noise itself is shared by neighbours, residuals of the class that are so show nothing
  // more.
  const bool shared_noise = smooth.noise_time > 1.0;
  const bool by_neighbours = correlation.time > 1.0 && !shared_noise;
  const double time = std::max(correlation.time, smooth.noise_time);
  // Whether a class that tells the noise misfits only neighbours on it show, which err together. It
  // does where sections leave more than the class: what they do not follow is no noise.
  const bool noise_is_told = noise_is_known_without_class(arcs, likelihood) &&
                             (likelihood.sigma_known || variance >= noise);
  // What the smooth model explains and the class does not, beyond what noise gives the smooth
  // model's further coefficients; a false alarm costs an answer its certainty.
  const int more = smooth.parameters - parameters;
  const double chance =
      noise_is_told && more > 0
          ? chi_square_survival((chi2 - smooth.chi2) / likelihood.inflation(), more)
          : 1.0;
  const bool misfits =
      noise_is_told ? unclassified || chance < kNegligibleProbability : by_neighbours;
  // White residuals larger than the smooth model's can be are noise that it took for bends
  // (outliers, samples out of order); correlated ones are form error up to its limit, neighbours
  // erring together, so that only one in `time` counts.
  // What is stated holds against residuals too few to tell a noise: of touches that lie apart,
  // which no smooth model follows.
  const bool tells_more = smooth.dof() > 0 || dof >= kFewestDegreesOfNoise;
  const bool noisy = likelihood.sigma_known && correlation.time == 1.0 && tells_more &&
                     !can_be_noise(chi2 / noise, dof) && excess <= kLargestNoise;
  const bool form_error = correlation.time > 1.0 && (excess <= kLargestFormError ||
                                                     !noise_is_told || is_stated(arcs, variance));
  ResidualExcess seen;
  seen.noise_inflation = likelihood.tempering;
  // White noise looks so once in a thousand times by its neighbours, and hardly ever by the smooth
  // model.
  seen.correlated = correlation.time > 1.0 || chance < kNegligibleProbability;
  if (misfits && (noisy || form_error)) {
    seen.noise_inflation = variance * time;
    seen.told_by_class_alone =
        noisy && likelihood.sigma_known && can_be_noise(smooth.chi2, smooth.dof());
    seen.correlation_length = correlation.length;
    seen.white_variance = noise_is_told && form_error ? 1.0 : variance;
    seen.likelihood = likelihood;
    seen.likelihood->sigma_known = true;
    seen.likelihood->samples = std::max(n / time, 1.0);
    seen.likelihood->tempering = seen.noise_inflation + likelihood.form_inflation();
    seen.likelihood->coherent_variance = 0.0;
    seen.likelihood->coherent_or_other = form_error;
  } else if (!likelihood.sigma_known) {
    seen.white_variance = misfit_of(chi2, likelihood) / dof;
    seen.noise_inflation = seen.white_variance * likelihood.tempering;
    seen.student_inflation = variance_of_student(dof / likelihood.tempering);
  }
  return seen;
}

}  // namespace palpate
