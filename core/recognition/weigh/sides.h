// Which side of the patches the material lies on, where round tips touched and no probe says it.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "core/recognition/fit/warm_start.h"
#include "core/recognition/posterior/posterior.h"
#include "core/recognition/samples/sample_memory.h"
#include "core/recognition/smooth/arcs.h"

namespace palpate {

struct SidedFits {
  ClassFits fits;   ///< of every class, to `reduced`
  FitData reduced;  ///< the arcs' reduced points, taken to the surface
  /// Per patch the side of travel on which the tip centres lie (tip_sides.h).
  std::vector<int> sides;
  /// log odds over the next best way for them to lie, priors included; infinite where the probes
  /// told.
  double margin = 0.0;
  std::vector<SidedStart> others;  ///< where the other ways are to be followed from
};

/// What the ways are judged by.
struct Judged {
  const Arcs& arcs;
  const Likelihood& likelihood;
  Evidences of_paths;              ///< with that of free-form paths, under this law or another
  unsigned classes = kAllClasses;  ///< by bit 1 << CurveClass
  double out_of_reach =
      std::numeric_limits<double>::infinity();  ///< as in fit_classes(), whatever the sides
};

/// Fits to the reduced points for the way the material lies beside the patches: where the probes do
/// not say it, the way of the highest evidence, the first (from outside the bends) at the odds of
/// the prior. `starts`: as in weigh().
SidedFits fit_over_sides(std::span<const StoredPatch> patches, const Judged& by,
                         std::span<const SidedStart> starts);

/// The same once more, where sides are open, under a law that `sided` was not told by: what is seen
/// to be more than noise tells sides no better than it tells classes. Returns whether the tips lie
/// another way then; where they do not, the fits stay as they are. `starts`: of all ways.
bool lie_otherwise(std::span<const StoredPatch> patches, Judged by,
                   std::span<const SidedStart> starts, SidedFits* sided);

}  // namespace palpate
