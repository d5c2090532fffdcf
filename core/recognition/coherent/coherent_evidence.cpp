#include "core/recognition/coherent/coherent_evidence.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/recognition/coherent/markov_drift.h"

namespace palpate {
namespace {

/// The residuals made white under a coherent deviation.
struct Whitened {
  double chi2 = 0.0;
  double log_determinant = 0.0;  ///< of their covariance, relative to noise alone
};

Whitened whitened(const std::vector<DriftStep>& steps, const Drift& drift) {
  Whitened result;
  double mean = 0.0;
  DriftFilter filter(drift);
  for (const DriftStep& step : steps) {
    const DriftFilter::Gain gain = filter.next(step);
    mean *= gain.kept;
    const double surprise = step.residual - mean;
    result.chi2 += surprise * surprise / gain.variance;
    result.log_determinant += std::log(gain.variance / step.variance);
    mean += gain.share * surprise;
  }
  return result;
}

}  // namespace

double log_coherent_evidence(const Likelihood& likelihood, const ClassEvidence& evidence,
                             const CanonicalFit& placed, const FitData& reduced, double sigma,
                             double samples, double chi2, double scatter, WorkBudget& work) {
  const std::vector<DriftStep> steps = drift_steps(placed, reduced, sigma);
  double white = 0.0;
  double whole = 0.0;
  for (const DriftStep& step : steps) {
    white += step.residual * step.residual / step.variance;
    whole += std::isfinite(step.from_last) ? step.from_last : 0.0;
  }
  const auto log_of = [&](const Whitened& residuals) {
    return likelihood.log_evidence(std::max(chi2 - white, scatter) + residuals.chi2,
                                   evidence.log_occam, evidence.determined) -
           0.5 * residuals.log_determinant;
  };
  // Variances in units of the noise's, uniform in the logarithm: from where the mean of all samples
  // hides the deviation (1 / n) to n. A factor of 4 is a factor of 2 in amplitude. Lengths: the
  // whole path, then halved down to a sixteenth, because the waves of parts and probes run a few
  // times around.
  constexpr double kFactor = 4.0;
  constexpr int kLengths = 5;
  // A residual alone, beside a row of all unknowns.
  constexpr std::size_t kScalars = 8;
  std::vector<double> logs;
  for (double variance = 1.0 / samples; variance <= samples; variance *= kFactor) {
    for (int k = 0; k < kLengths; ++k) {
      work.spend(WorkKind::PlacedRow, steps.size() / kScalars);
      logs.push_back(log_of(whitened(steps, {std::sqrt(variance), std::ldexp(whole, -k)})));
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
