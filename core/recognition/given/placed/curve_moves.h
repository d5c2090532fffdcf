// How one curve of a class is moved to another.
#pragma once

#include <array>

#include "core/recognition/given/placed/placed_curve.h"

namespace palpate {

/// The step of the unknowns from one curve to another of its class.
struct CurveMove {
  std::array<double, kMostUnknowns> step{};
  /// The other curve, turned by half a turn that leaves it the same, runs backwards: its sides are
  /// the other ones.
  bool backwards = false;
};

/// Of the two poses that a curve with a symmetry has, the one nearer to `from` is taken.
CurveMove move_between(const PlacedCurve<double>& from, const PlacedCurve<double>& to);

/// True if the two are one curve to much less than any noise moves them. They may have been
/// reached by different ways. `backwards`: their directions differ.
bool is_same_curve(const PlacedCurve<double>& u, const PlacedCurve<double>& v, bool* backwards);

}  // namespace palpate
