// A slow exhaustive search that shows what single touches determine about their class.
#pragma once

#include <array>

#include "core/recognition/posterior/posterior.h"
#include "tests/support/lone_touches.h"

namespace palpate::test {

struct TouchReference {
  /// By CurveClass, for the touches as they are: not joined to strokes, not reduced.
  ClassProbabilities probabilities{};
  /// The least chi-square of each class over all starts; infinite if it has no optimum.
  std::array<double, 9> chi2{};
  /// True if every class passes through the touches in finitely many ways only. Otherwise the
  /// probabilities are of the classes that do.
  bool compares_all = false;
  bool knows_shape = false;   ///< of the true class, as well as RECOGNIZED requires
  double other_shapes = 0.0;  ///< share of the true class's probability that its other optima have
};

/// Fits every class to all touches, from the starts of three searches (fit_classes, the fit of a
/// given class, fit_classes on every third touch) and from the truth. Of each class the optimum
/// with the highest integrated evidence counts, except needles that go forth and back between the
/// touches of one edge (each touch is equally likely anywhere along the curve). For surface points
/// with stated noise.
TouchReference reference_of(const LoneTouches& touches);

/// Counts of the recognizer's answers compared with the reference.
struct BesideReference {
  int scenes = 0;
  int determined = 0;  ///< the reference gives the true class the probability that RECOGNIZED needs
  int sure = 0;        ///< of these: the recognizer does too
  int recognized = 0;  ///< of these: RECOGNIZED as that class
  /// Of the sure ones, not RECOGNIZED: fewer than two touches more than unknowns.
  int few_places = 0;
  int two_shapes = 0;  ///< likewise: two shapes of the class fit equally well, by the reference too
  int shape_unknown = 0;  ///< likewise: the shape is not known well enough, by the reference too
  int other_doubt = 0;    ///< likewise: for a reason that the reference does not share
  int mistaken = 0;       ///< of the determined ones: RECOGNIZED as another class
  int wrong = 0;          ///< of all: RECOGNIZED as another class
  int missed = 0;         ///< an optimum of a class that matters by the reference was missed
  double farthest = 0.0;  ///< largest difference of a class's probability, determined or not

  void add(const LoneTouches& touches);
  BesideReference& operator+=(const BesideReference& other);

 private:
  int* counted_for(Doubt doubt, const TouchReference& reference);
};

}  // namespace palpate::test
