// From weighed hypotheses to the answer: the most probable class, and what speaks against it.
#pragma once

#include "core/recognition/recognition.h"
#include "core/recognition/weigh/best_moments.h"
#include "core/recognition/weigh/weigh.h"

namespace palpate {

struct VerdictOptions {
  double recognized_probability;  ///< as RecognizerOptions
  double determined_fraction;     ///< likewise
};

/// Noise of the typical sample; where it was estimated, by the best class's residuals. [m]
double residual_noise_m(const Weighing& weighing);

/// All of the answer but contacts, tree and counts of samples. `stored`: samples in memory, of
/// which those that the weighing has not were set aside as spikes.
Recognition answer_by_likelihood(const Weighing& weighing, const BestMoments& moments,
                                 const VerdictOptions& options, std::size_t stored);

}  // namespace palpate
