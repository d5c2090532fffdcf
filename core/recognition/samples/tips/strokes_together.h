// Finds strokes that run along one another: their tips are on the same side of the same wall.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/samples/fit_data.h"
#include "core/recognition/samples/stored_patch.h"

namespace palpate {

/// The stroke that one is compared with.
struct Alongside {
  std::size_t first = 0;  ///< the first patch of those that run together; itself if it runs alone
  int sense = 1;          ///< +1 if it travels as that one does, -1 if against it
};

/// For each patch of tip centres, with whom it runs. The passes of one stroke run together
/// (passes.h). So do strokes of the same tip, told by their longest pass, if the centres of one lie
/// on the path of the other, to within noise or a tenth of the tip's radius: at least three
/// centres, over at least a radius, and all but a quarter of those beside that path.
///
/// Two strokes on the two sides of a wall are apart by two radii and the wall; those on the two
/// walls of a groove by what the groove is wider than the tip, so that a groove which is wider by
/// less than a tenth of the radius is taken for one wall. Points without a direction, and tips no
/// larger than the noise, run alone.
std::vector<Alongside> strokes_together(std::span<const StoredPatch> patches,
                                        const FitData& centres, WorkBudget& work);

}  // namespace palpate
