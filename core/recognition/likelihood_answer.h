// From weighed hypotheses to the answer: the most probable class, and the doubt about it.
#pragma once

#include "core/recognition/recognition.h"
#include "core/recognition/weigh/best_moments.h"
#include "core/recognition/weigh/weigh.h"

namespace palpate {

struct VerdictOptions {
  double recognized_probability;  ///< as RecognizerOptions
  double determined_fraction;     ///< as RecognizerOptions
};

/// The answer without contacts, tree and counts of samples. `stored`: number of samples, including
/// those set aside as spikes.
Recognition answer_by_likelihood(const Weighing& weighing, const BestMoments& moments,
                                 const VerdictOptions& options, std::size_t stored);

}  // namespace palpate
