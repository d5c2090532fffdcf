// What touches one at a time tell of their class, by a search that leaves nothing out and takes
// its time.
#pragma once

#include <array>

#include "core/recognition/posterior/posterior.h"
#include "tests/support/lone_touches.h"

namespace palpate::test {

struct TouchReference {
  /// By CurveClass, of the touches as they are: none strung, none reduced.
  ClassProbabilities probabilities{};
  /// The least chi-square of each class that any start led to; infinite where it has no optimum.
  std::array<double, 9> chi2{};
};

/// Every class is fitted to all touches from the starts of three searches (fit_classes, the fit of
/// a class that is given, fit_classes on every third touch) and from the truth; the optimum of the
/// highest evidence counts, integrated, where it is no needle that goes there and back between the
/// touches of one edge (each touch lies anywhere along the curve with the same density). Of surface
/// points whose noise is stated.
TouchReference reference_of(const LoneTouches& touches);

/// The recogniser beside it, counted.
struct BesideReference {
  int scenes = 0;
  int determined = 0;     ///< the reference gives the true class what RECOGNIZED takes
  int sure = 0;           ///< of these: so does the recogniser
  int recognized = 0;     ///< of these: RECOGNIZED as that
  int mistaken = 0;       ///< of these: RECOGNIZED as another
  int wrong = 0;          ///< of all: RECOGNIZED as another
  int missed = 0;         ///< an optimum of a class that matters by the reference was missed
  double farthest = 0.0;  ///< largest difference of a class's probability, determined or not

  void add(const LoneTouches& touches);
  BesideReference& operator+=(const BesideReference& other);
};

}  // namespace palpate::test
