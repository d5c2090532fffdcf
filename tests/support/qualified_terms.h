// Compares every term of a qualification with the truth about the probe.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "core/qualification/probe_character.h"

namespace palpate::test {

struct QualifiedTerm {
  std::string name;
  double truth = 0.0;
  Estimate estimate;
  double deviations() const { return (estimate.value - truth) / estimate.deviation; }
};

/// Constant, harmonics to order 3 (0 +- 0 where the estimate has none), noise, coherent deviation
/// and its length, spike rate; and the lag if both have one.
inline std::vector<QualifiedTerm> qualified_terms(const ProbeCharacter& truth,
                                                  const ProbeCharacter& estimate) {
  std::vector<QualifiedTerm> terms;
  constexpr const char* kNames[] = {"constant", "cos 2", "sin 2", "cos 3", "sin 3"};
  for (Eigen::Index i = 0; i < 5; ++i) {
    const auto of = [&](const ProbeCharacter& probe) {
      return i < probe.offset.coefficients_m.size() ? probe.offset.coefficients_m[i] : 0.0;
    };
    const double variance =
        i < estimate.offset.covariance_m2.rows() ? estimate.offset.covariance_m2(i, i) : 0.0;
    terms.push_back({kNames[i], of(truth), {of(estimate), std::sqrt(variance)}});
  }
  terms.push_back({"sigma", truth.sigma_m.value, estimate.sigma_m});
  terms.push_back({"deviation", truth.deviation_m.value, estimate.deviation_m});
  terms.push_back({"length", truth.deviation_length_m.value, estimate.deviation_length_m});
  terms.push_back({"spikes", truth.spike_probability.value, estimate.spike_probability});
  if (truth.lag_m && estimate.lag_m) terms.push_back({"lag", truth.lag_m->value, *estimate.lag_m});
  return terms;
}

}  // namespace palpate::test
