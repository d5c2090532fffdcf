// Which samples a picture shows: those that lie on another one's dot cannot be seen.
#pragma once

#include <cstddef>
#include <vector>

#include "node/tool/contact_groups.h"

namespace palpate {

struct VisibleSamples {
  /// By run: indices of the samples to draw, in order.
  std::vector<std::vector<std::size_t>> of_run;
  std::size_t drawn = 0;
  std::size_t left_out = 0;
  double cell_m = 0.0;  ///< of the samples in a square of this side the first is drawn
};

/// One sample a run's colour and square of side `cell_m`; where that leaves more than `most`, the
/// squares are doubled until it does not. Runs `colours` apart have the same colour.
VisibleSamples visible_samples(const ContactGroup& group, double cell_m, std::size_t most,
                               std::size_t colours);

}  // namespace palpate
