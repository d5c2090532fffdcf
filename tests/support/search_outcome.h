// Tests whether the search for a class's optimum finds it, compared with the optimum reached from
// the truth.
#pragma once

#include <cstdint>
#include <string_view>

#include "tests/support/random_scene.h"

namespace palpate::test {

/// The input of one search. Sizes do not matter: everything is in units of the piece's size.
struct SearchCase {
  Scene scene;
  double tip_radius_m = 0.0;  ///< 0 = the samples lie on the surface
};

/// Case `number` of the sequence `seed`: 1 to 6 patches of 10 to 200 samples, arcs of 0.05 to 4
/// sizes and noise of 1e-6 to 1e-2 sizes, log-uniform. One case in four is touched by a tip of
/// known side, with a radius of 1e-3 to 1e-1 sizes, from outside the bends.
SearchCase search_case(CurveClass curve_class, std::uint64_t seed, std::uint32_t number);

/// The same for single touches in no order: every patch is one sample. The number of touches is
/// log-uniform from one more than the class has unknowns to 60. They lie on one to three arcs as
/// above, which may be next to a cusp or across it.
SearchCase lone_search_case(CurveClass curve_class, std::uint64_t seed, std::uint32_t number);

struct SearchOutcome {
  bool counted = false;  ///< the truth leads to an optimum of the class; else there is none
  /// The optimum reached from the truth is rejected as one that cannot have been touched.
  bool refused = false;
  bool curve = true;        ///< the search found a curve on which the points can have been touched
  double found_chi2 = 0.0;  ///< infinite if it found none
  double truth_chi2 = 0.0;  ///< of the optimum reached from the truth
  double excess() const { return found_chi2 - truth_chi2; }
};

/// For the scene's class: searches on the reduced points and then refines on all points, as the
/// recognizer does with its best class.
SearchOutcome outcome_on_reduced(const SearchCase& search_case);
SearchOutcome outcome_on_all(const SearchCase& search_case);

}  // namespace palpate::test
