// Curves that may give the order of single touches along the part.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/curves/curve.h"
#include "core/curves/pose2.h"
#include "core/numerics/work_budget.h"
#include "core/recognition/fit/warm_start.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Sorts by the parameter along the curve. A closed curve starts after the largest gap.
template <typename T, typename ParameterOf>
void sort_along(const Curve& curve, std::vector<T>* things, const ParameterOf& parameter_of) {
  const auto before = [&](const T& a, const T& b) { return parameter_of(a) < parameter_of(b); };
  std::sort(things->begin(), things->end(), before);
  const double period = domain(curve).period;
  if (!(period > 0.0) || things->size() < 2) {
    return;
  }
  double widest = period + parameter_of(things->front()) - parameter_of(things->back());
  std::size_t first = 0;
  for (std::size_t i = 1; i < things->size(); ++i) {
    const double gap = parameter_of((*things)[i]) - parameter_of((*things)[i - 1]);
    if (gap > widest) {
      widest = gap;
      first = i;
    }
  }
  std::rotate(things->begin(), things->begin() + static_cast<std::ptrdiff_t>(first), things->end());
}

/// A curve that was fitted to touches.
struct PlacedCurve {
  Curve curve;
  Pose2 world_T_curve;
  double chi2 = 0.0;
  std::vector<Vec2> touches_m;  ///< in their order along the curve
};

/// Curves by which to order the touches, the likeliest first. `start` receives the fits if every
/// class was searched.
std::vector<PlacedCurve> curves_through(const FitData& data, unsigned classes,
                                        std::optional<WarmStart>* start, WorkBudget& work);

}  // namespace palpate
