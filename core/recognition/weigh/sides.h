// Which side of the patches the material lies on, where round tips touched and no probe says it.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/warm_start.h"
#include "core/recognition/posterior/posterior.h"
#include "core/recognition/samples/sample_memory.h"
#include "core/recognition/smooth/arcs.h"

namespace palpate {

/// The classes fitted for one way in which the tips may lie.
struct Way {
  /// Per patch the side of travel on which the tip centres lie (tip_sides.h).
  std::vector<int> sides;
  ClassFits fits;   ///< of every class, to `reduced`
  FitData reduced;  ///< the arcs' reduced points, taken to the surface
  CurveClass candidate = CurveClass::Unclassified;
  std::optional<ClassFit> settled;  ///< the candidate at its optimum on the reduced points
  std::optional<ClassFit> refined;  ///< on all points, unless these tell what the reduced ones do
  Evidences evidences;
};

struct SidedFits {
  std::vector<Way> ways;  ///< the first is from outside the bends, where probes do not tell
  std::size_t taken = 0;  ///< the most probable of them
  /// log odds over the next best way for them to lie, priors included; infinite where the probes
  /// told.
  double margin = std::numeric_limits<double>::infinity();
  /// Where the curve of the tips' centres is to be followed from, if it was needed.
  std::optional<SidedStart> centres;

  const Way& way() const { return ways[taken]; }
};

/// What the ways are judged by.
struct Judged {
  const Arcs& arcs;
  const Likelihood& likelihood;
  WorkBudget& work;
  Evidences of_paths;              ///< with that of free-form paths, under this law
  unsigned classes = kAllClasses;  ///< by bit 1 << CurveClass
  double out_of_reach =
      std::numeric_limits<double>::infinity();  ///< as in fit_classes(), whatever the sides
};

/// Fits to the reduced points for the way the material lies beside the patches: where the probes do
/// not say it, the way of the highest evidence, the first (from outside the bends) at the odds of
/// the prior. `starts`: as in weigh().
SidedFits fit_over_sides(std::span<const StoredPatch> patches, const Judged& by,
                         std::span<const SidedStart> starts);

/// The ways judged once more, where sides are open, under a law that they were not fitted by: what
/// is seen to be more than noise tells sides no better than it tells classes. The fits stay: least
/// squares are the same under either law. (What was out of reach under the first stays out: it
/// leaves more than the largest noise, and the second has none larger.) Returns whether another way
/// is taken then.
bool lie_otherwise(const Judged& by, SidedFits* sided);

}  // namespace palpate
