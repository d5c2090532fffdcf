// All places of a cubic that are nearer to a point than those beside them.
#pragma once

#include <array>
#include <cstddef>

#include "core/curves/cubic_spline.h"
#include "core/curves/cubical_parabola.h"
#include "core/curves/semi_cubical_parabola.h"

namespace palpate {

/// Parameters of a curve, in any order.
struct FootPlaces {
  static constexpr std::size_t kMost = 6;  ///< five roots of the condition, and a cusp
  std::array<double, kMost> t{};
  std::size_t count = 0;

  void add(double place) { t[count++] = place; }
};

/// The feet of `point`, a finite one, that are local minima of the distance; with the cusp in any
/// case. To a few roundings.
FootPlaces all_feet(const CubicalParabola& curve, const Vec2& point);
FootPlaces all_feet(const SemiCubicalParabola& curve, const Vec2& point);
FootPlaces all_feet(const CubicSpline& curve, const Vec2& point);

}  // namespace palpate
