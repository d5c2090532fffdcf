#include "core/recognition/given/placed/curve_moves.h"

#include <cmath>

namespace palpate {

CurveMove move_between(const PlacedCurve<double>& from, const PlacedCurve<double>& to) {
  const Unknowns unknowns(from.curve_class);
  CurveMove move;
  for (int i = 0; i < unknowns.shape; ++i) {
    move.step[static_cast<std::size_t>(i)] = to.shape[i] - from.shape[i];
  }
  const PlaneVector<double> away = to.origin - from.origin;
  if (unknowns.x >= 0) {
    move.step[static_cast<std::size_t>(unknowns.x)] = inner(from.axis, away);
  }
  move.step[static_cast<std::size_t>(unknowns.y)] = inner(left(from.axis), away);
  if (unknowns.angle >= 0) {
    PlaneVector<double> axis = to.axis;
    const bool half_turn =
        from.curve_class == CurveClass::Line || pose_symmetry(from.curve_class) == 2;
    if (half_turn && inner(from.axis, axis) < 0.0) {
      axis = -1.0 * axis;
      move.backwards = from.curve_class != CurveClass::Ellipse;
    }
    move.step[static_cast<std::size_t>(unknowns.angle)] =
        std::atan2(inner(left(from.axis), axis), inner(from.axis, axis));
  }
  return move;
}

bool is_same_curve(const PlacedCurve<double>& u, const PlacedCurve<double>& v, bool* backwards) {
  // Of the unknowns, which are of the size of 1: two descents end that near to one another.
  constexpr double kSame = 1e-5;
  const CurveMove move = move_between(u, v);
  *backwards = move.backwards;
  const Unknowns unknowns(u.curve_class);
  const double far = std::sqrt(inner(u.origin, u.origin));
  for (int i = 0; i < unknowns.count; ++i) {
    const double size = i < unknowns.shape ? std::abs(u.shape[i]) : i == unknowns.angle ? 0.0 : far;
    if (!(std::abs(move.step[static_cast<std::size_t>(i)]) <= kSame * (1.0 + size))) {
      return false;
    }
  }
  return true;
}

}  // namespace palpate
