// The ways in which the tips may lie, with their fits, and the one that is taken.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/weigh/side_choice.h"
#include "core/recognition/weigh/sided_start.h"

namespace palpate {

struct SidedFits {
  std::vector<SideChoice> choices;
  std::size_t taken = 0;  ///< index of the most probable one
  /// log odds over the next best choice of sides, at least: by what was measured and stated alone,
  /// and by the prior too. Below 0 if another choice fits better, 0 if no choice has evidence,
  /// infinite if all sides are known.
  double margin = std::numeric_limits<double>::infinity();
  /// The samples ask for sides against which all measured normals together speak beyond doubt.
  bool against_normals() const { return 2.0 * choice().log_of_normals < -kNegligibleLogOdds; }
  /// Start for following the curve of the tips' centres, if it was needed.
  std::optional<SidedStart> centres;

  const SideChoice& choice() const { return choices[taken]; }
};

}  // namespace palpate
