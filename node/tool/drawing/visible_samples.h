// Selects the samples that a picture shows: a sample on the dot of another one cannot be seen.
#pragma once

#include <cstddef>
#include <vector>

#include "node/tool/contact_groups.h"

namespace palpate {

struct VisibleSamples {
  /// For each run: indices of the samples to draw, in order.
  std::vector<std::vector<std::size_t>> of_run;
  std::size_t drawn = 0;
  std::size_t left_out = 0;
  double cell_m = 0.0;  ///< of the samples in a square with this side, the first is drawn
};

/// Keeps one sample per square of side `cell_m` and colour of the runs. If more than `most` remain,
/// the side is doubled until they do not. Runs whose numbers differ by a multiple of `colours` have
/// the same colour.
VisibleSamples visible_samples(const ContactGroup& group, double cell_m, std::size_t most,
                               std::size_t colours);

}  // namespace palpate
