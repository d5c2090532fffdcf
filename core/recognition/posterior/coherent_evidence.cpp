#include "core/recognition/posterior/coherent_evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/recognition/posterior/runs_along.h"

namespace palpate {
namespace {

/// One point of a run, in units of the typical noise.
struct Step {
  double residual = 0.0;
  double variance = 1.0;   ///< of its noise
  double from_last = 0.0;  ///< distance, normalised; infinite where a run begins
};

std::vector<Step> steps_of(const CanonicalFit& placed, const FitData& reduced, double sigma) {
  const Runs runs = runs_along(placed, reduced.patches);
  std::vector<Step> steps;
  steps.reserve(runs.order.size());
  for (const PatchSpan& run : runs.spans) {
    for (std::size_t k = run.begin; k < run.end; ++k) {
      const std::size_t i = runs.order[k];
      const FitPoint& point = reduced.points[i];
      const double deviation = 1.0 / (point.inverse_sigma * sigma);
      const double from_last =
          k > run.begin ? (point.position - reduced.points[runs.order[k - 1]].position).norm()
                        : std::numeric_limits<double>::infinity();
      steps.push_back({placed.points[i].residual * deviation, deviation * deviation, from_last});
    }
  }
  return steps;
}

/// What a coherent deviation makes of residuals.
struct Whitened {
  double chi2 = 0.0;
  double log_determinant = 0.0;  ///< of their covariance over that of the noise alone
};

/// Kalman's recursion: the deviation has `variance`, correlation exp(-distance / length).
Whitened whitened(const std::vector<Step>& steps, double variance, double length) {
  Whitened result;
  double mean = 0.0;
  double spread = variance;
  for (const Step& step : steps) {
    const double kept = std::exp(-step.from_last / length);
    mean *= kept;
    spread = kept * kept * spread + (1.0 - kept * kept) * variance;
    const double of_residual = spread + step.variance;
    const double surprise = step.residual - mean;
    result.chi2 += surprise * surprise / of_residual;
    result.log_determinant += std::log(of_residual / step.variance);
    mean += spread / of_residual * surprise;
    spread *= step.variance / of_residual;
  }
  return result;
}

}  // namespace

double log_coherent_evidence(const Likelihood& likelihood, const ClassEvidence& evidence,
                             const CanonicalFit& placed, const FitData& reduced, double sigma,
                             double samples, double chi2, double scatter) {
  const std::vector<Step> steps = steps_of(placed, reduced, sigma);
  double white = 0.0;
  double whole = 0.0;
  for (const Step& step : steps) {
    white += step.residual * step.residual / step.variance;
    whole += std::isfinite(step.from_last) ? step.from_last : 0.0;
  }
  const auto log_of = [&](const Whitened& residuals) {
    return likelihood.log_evidence(std::max(chi2 - white, scatter) + residuals.chi2,
                                   evidence.log_occam, evidence.determined) -
           0.5 * residuals.log_determinant;
  };
  // Variances, in units of the noise's, from where the mean of all samples hides the deviation to
  // where it is to the noise what that is to the mean: alike probable on the scale of logarithms.
  // A factor of 4 is one of 2 in amplitude. Lengths halve from the whole way on to a sixteenth of
  // it: the waves of parts and probes run a few times around.
  constexpr double kFactor = 4.0;
  constexpr int kLengths = 5;
  std::vector<double> logs;
  for (double variance = 1.0 / samples; variance <= samples; variance *= kFactor) {
    for (int k = 0; k < kLengths; ++k) {
      logs.push_back(log_of(whitened(steps, variance, std::ldexp(whole, -k))));
    }
  }
  const double none = log_of({white, 0.0});
  const double top = std::max(none, *std::max_element(logs.begin(), logs.end()));
  double sum = 0.0;
  for (const double log : logs) {
    sum += std::exp(log - top) / static_cast<double>(logs.size());
  }
  return top + std::log(0.5 * std::exp(none - top) + 0.5 * sum);
}

}  // namespace palpate
