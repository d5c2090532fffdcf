// Whether the search for a class's optimum finds it: beside the optimum reached from the truth.
#pragma once

#include <cstdint>
#include <string_view>

#include "tests/support/random_scene.h"

namespace palpate::test {

/// What the search is tried on. Sizes do not matter to it: all is in units of the piece's size.
struct SearchCase {
  Scene scene;
  double tip_radius_m = 0.0;  ///< 0 = the samples lie on the surface
};

/// Case `number` of the sequence `seed`: 1 to 6 patches of 10 to 200 samples, arcs of 0.05 to 4
/// sizes and noise of 1e-6 to 1e-2 sizes, log-uniform; in one of four a tip of known side, its
/// radius 1e-3 to 1e-1 sizes, touches from outside the bends.
SearchCase search_case(CurveClass curve_class, std::uint64_t seed, std::uint32_t number);

/// The same of touches one at a time, in no order: every patch is a single sample. One more than
/// the class has unknowns to 60 of them, log-uniform, on one to three arcs as above, which may lie
/// next to a cusp and across it.
SearchCase lone_search_case(CurveClass curve_class, std::uint64_t seed, std::uint32_t number);

struct SearchOutcome {
  bool counted = false;  ///< the truth leads to an optimum of the class; else there is none
  bool refused = false;  ///< the truth leads to one that is taken for none that can be touched
  bool curve = true;     ///< the search ended at a curve that the points can have been touched on
  double found_chi2 = 0.0;  ///< infinite where it ended at none
  double truth_chi2 = 0.0;  ///< of the optimum that the truth leads to
  double excess() const { return found_chi2 - truth_chi2; }
};

/// Of the scene's class: on the reduced points, and from there on all points, as the recogniser
/// takes its best class to its optimum.
SearchOutcome outcome_on_reduced(const SearchCase& search_case);
SearchOutcome outcome_on_all(const SearchCase& search_case);

}  // namespace palpate::test
