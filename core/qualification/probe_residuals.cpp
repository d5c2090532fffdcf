#include "core/qualification/probe_residuals.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/numerics/probability/negligible.h"

namespace palpate {
namespace {

/// Of the covariance of residuals in units of the white noise, 1 + D / (sigma sigma): what is
/// needed of its eigenvalues.
struct Spectrum {
  double excess = 0.0;   ///< their sum beyond 1 for each sample
  double squares = 0.0;  ///< sum of their squares
  double largest = 1.0;  ///< at most
};

/// For each sample, the sum of (exp(-distance / length) / sigma)^power over the samples before it,
/// or after it: a recursion.
std::vector<double> sums_beside(const ProbedPatch& patch, int power, bool after) {
  const std::size_t n = patch.samples.size();
  const double length_m = patch.probe->deviation_length_m.value / power;
  std::vector<double> sums(n);
  for (std::size_t k = 1; k < n; ++k) {
    const std::size_t i = after ? n - 1 - k : k;
    const std::size_t last = after ? i + 1 : i - 1;
    const ContactSample& beside = patch.samples[last];
    const double step_m = (patch.samples[i].position_m - beside.position_m).norm();
    sums[i] = (sums[last] + std::pow(beside.sigma_m, -power)) * std::exp(-step_m / length_m);
  }
  return sums;
}

/// D_ij = deviation^2 exp(-distance / length).
void add_patch(const ProbedPatch& patch, Spectrum* spectrum) {
  const double variance = mean_square(patch.probe->deviation_m);
  const std::vector<double> before = sums_beside(patch, 1, false);
  const std::vector<double> after = sums_beside(patch, 1, true);
  const std::vector<double> squares_before = sums_beside(patch, 2, false);
  for (std::size_t i = 0; i < patch.samples.size(); ++i) {
    const double sigma = patch.samples[i].sigma_m;
    const double own = variance / (sigma * sigma);
    const double shared = variance / sigma;
    spectrum->excess += own;
    spectrum->squares += 2.0 * own + own * own + 2.0 * shared * shared * squares_before[i];
    spectrum->largest =
        std::max(spectrum->largest, 1.0 + own + shared * (before[i] + after[i]));  // Gershgorin
  }
}

}  // namespace

double most_chi2_of_probes(std::span<const ProbedPatch> patches, int dof) {
  Spectrum spectrum;
  spectrum.squares = dof;
  for (const ProbedPatch& patch : patches) {
    const bool has_noise = std::all_of(patch.samples.begin(), patch.samples.end(),
                                       [](const ContactSample& s) { return s.sigma_m > 0.0; });
    if (patch.probe != nullptr && has_noise && patch.probe->deviation_length_m.value > 0.0) {
      add_patch(patch, &spectrum);
    }
  }
  if (!(spectrum.excess > 0.0)) {
    return most_of_noise(dof);
  }
  // A sum of squares of normal variables with these variances exceeds it with probability exp(-x)
  // at most (B. Laurent and P. Massart, 2000, lemma 1).
  constexpr double x = kNegligibleLogOdds;
  return dof + spectrum.excess + 2.0 * std::sqrt(spectrum.squares * x) + 2.0 * spectrum.largest * x;
}

}  // namespace palpate
