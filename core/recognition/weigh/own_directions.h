// Every class with round tips taken off along its own directions.
#pragma once

#include <span>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/samples/fit_data.h"
#include "core/recognition/smooth/smooth_model.h"

namespace palpate {

/// Of the classes, beside the fits that are to be moved; each may be nullptr.
struct OtherStarts {
  const ClassFits* of_centres = nullptr;  ///< fitted to the tips' centres themselves
  const ClassFits* before = nullptr;      ///< along their own directions, before a new search
};

/// Whether any tip touched once. Along a stroke, or touches that are joined, neighbours tell the
/// directions nearly, and to move every class in a search takes a work that it has not got there.
bool has_lone_tips(const FitData& reduced, const SmoothModel& smooth);

/// The fits to `reduced`, each moved to where its class has the tips' centres at the distance of
/// their radii, if it leaves less there; and with the surface points that it has there.
///
/// Points that show no direction of their own lie on `reduced` along that of one curve. Another
/// class does not have them: directions that differ by an angle put the surface off by half its
/// square times the tip's radius. Centres have no directions. `sides`: of the patches, as `reduced`
/// has them. O(points) per step.
ClassFits along_own_directions(ClassFits fits, const FitData& reduced, std::span<const int> sides,
                               const SmoothModel& smooth, const OtherStarts& others,
                               WorkBudget& work);

}  // namespace palpate
