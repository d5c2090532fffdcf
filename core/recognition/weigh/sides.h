// Finds the side of the patches on which the material lies, for round tips without a stated side.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/samples/sample_memory.h"
#include "core/recognition/weigh/side_choice.h"
#include "core/recognition/weigh/sided_start.h"

namespace palpate {

struct SidedFits {
  std::vector<SideChoice> choices;
  std::size_t taken = 0;  ///< index of the most probable one
  /// log odds over the next best choice of sides, by what was measured and stated alone; below 0 if
  /// another choice fits better, 0 if no choice has evidence, infinite if all sides are known.
  double margin = std::numeric_limits<double>::infinity();
  /// The samples ask for sides against which all measured normals together speak beyond doubt.
  bool against_normals() const { return 2.0 * choice().log_of_normals < -kNegligibleLogOdds; }
  /// Start for following the curve of the tips' centres, if it was needed.
  std::optional<SidedStart> centres;

  const SideChoice& choice() const { return choices[taken]; }
};

/// Fits the classes to the reduced points and chooses the sides of the tips. If sides are not
/// known, it takes the choice of highest evidence; the expected one has the odds of the prior.
/// `starts`: as in weigh().
SidedFits fit_over_sides(std::span<const StoredPatch> patches, const SideContext& by,
                         std::span<const SidedStart> starts);

/// Compares the choices of sides again under another likelihood than they were fitted by, if sides
/// are open: a deviation that is more than noise also makes sides harder to tell. The fits stay,
/// because least squares are the same under both. (Classes out of reach under the first likelihood
/// stay out: their residuals exceed the largest noise of both.) Returns whether the choice changed.
bool rejudge_sides(const SideContext& by, SidedFits* sided);

}  // namespace palpate
