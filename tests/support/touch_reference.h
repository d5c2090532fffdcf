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
  /// Whether every class can go through the touches in a number of ways only: else the
  /// probabilities are of those that do.
  bool compares_all = false;
  bool knows_shape = false;   ///< of the true class, to what RECOGNIZED asks
  double other_shapes = 0.0;  ///< share of the true class that its other optima have
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
  int few_places = 0;     ///< of the sure, not RECOGNIZED: fewer than two touches are left over
  int two_shapes = 0;     ///< of them: two shapes of the class fit alike, by the reference too
  int shape_unknown = 0;  ///< of them: the shape is not known well enough, by the reference too
  int other_doubt = 0;    ///< of them: for a reason that the reference does not share
  int mistaken = 0;       ///< of the determined: RECOGNIZED as another
  int wrong = 0;          ///< of all: RECOGNIZED as another
  int missed = 0;         ///< an optimum of a class that matters by the reference was missed
  double farthest = 0.0;  ///< largest difference of a class's probability, determined or not

  void add(const LoneTouches& touches);
  BesideReference& operator+=(const BesideReference& other);

 private:
  int* counted_for(Doubt doubt, const TouchReference& reference);
};

}  // namespace palpate::test
