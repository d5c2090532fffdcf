#include "core/recognition/posterior/likelihood.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/probability/log_gamma.h"

namespace palpate {

double Likelihood::counted(double chi2) const {
  if (coherent_variance > 0.0) {
    chi2 = noise_chi2 + (chi2 - noise_chi2) / (1.0 + coherent_variance);
  }
  return chi2 / tempering;
}

double Likelihood::left(double chi2) const {
  return std::max(counted(chi2) + chi2_floor, std::numeric_limits<double>::min());
}

double Likelihood::freedom(double determined) const { return std::max(samples - determined, 1.0); }

double Likelihood::log_evidence(double chi2, double log_occam, double determined) const {
  if (sigma_known) {
    return log_occam - 0.5 * counted(chi2);
  }
  // Integral of sigma^-(n - d) exp(-chi2 / (2 sigma^2)) d(log sigma): each determined coordinate
  // narrows as sigma does.
  const auto integral = [&](double coordinates) {
    const double half = 0.5 * freedom(coordinates);
    return log_gamma(half) - half * std::log(0.5 * left(chi2));
  };
  // That ends where the noise of a bad fit leaves a coordinate to the prior: no prior leaves more
  // than all of the likelihood.
  return std::min(log_occam + integral(determined), integral(0.0));
}

double misfit_of(double chi2, const Likelihood& likelihood) {
  Likelihood untempered = likelihood;
  untempered.tempering = 1.0;
  return std::min(chi2, untempered.counted(chi2));
}

double log_odds(double probability) { return std::log(probability / (1.0 - probability)); }

}  // namespace palpate
