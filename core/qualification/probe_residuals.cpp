#include "core/qualification/probe_residuals.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/numerics/negligible.h"

namespace palpate {
namespace {

/// Of the covariance of residuals in units of the white noise, 1 + D / (sigma sigma): what is
/// needed of its eigenvalues.
struct Spectrum {
  double excess = 0.0;   ///< their sum beyond 1 for each sample
  double squares = 0.0;  ///< sum of their squares
  double largest = 1.0;  ///< at most
};

/// Row sums of D / (deviation^2 sigma) over the samples before each, in the order of `patch`, or
/// from its end. D_ij = deviation^2 exp(-distance / length): a recursion.
std::vector<double> sums_before(const ProbedPatch& patch, bool from_end) {
  const std::size_t n = patch.samples.size();
  std::vector<double> sums(n);
  double sum = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = from_end ? n - 1 - k : k;
    if (k > 0) {
      const ContactSample& last = patch.samples[from_end ? i + 1 : i - 1];
      const double step = (patch.samples[i].position_m - last.position_m).norm();
      sum = (sum + 1.0 / last.sigma_m) * std::exp(-step / patch.probe->deviation_length_m.value);
    }
    sums[i] = sum;
  }
  return sums;
}

void add_patch(const ProbedPatch& patch, Spectrum* spectrum) {
  const double variance = mean_square(patch.probe->deviation_m);
  const std::vector<double> before = sums_before(patch, false);
  const std::vector<double> after = sums_before(patch, true);
  double squares_before = 0.0;  // sum of (D_ij / deviation^2 / sigma_j)^2 over the samples before
  for (std::size_t i = 0; i < patch.samples.size(); ++i) {
    const double sigma = patch.samples[i].sigma_m;
    if (i > 0) {
      const ContactSample& last = patch.samples[i - 1];
      const double step = (patch.samples[i].position_m - last.position_m).norm();
      squares_before = (squares_before + 1.0 / (last.sigma_m * last.sigma_m)) *
                       std::exp(-2.0 * step / patch.probe->deviation_length_m.value);
    }
    const double own = variance / (sigma * sigma);
    const double shared = variance / sigma;
    spectrum->excess += own;
    spectrum->squares += 2.0 * own + own * own + 2.0 * shared * shared * squares_before;
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
