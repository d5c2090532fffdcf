// Starting points for the polynomial classes: an exhaustive coarse search that needs neither
// kappa_s nor the order of the patches nor their directions of travel.
#pragma once

#include <span>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/axis_fit.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Per model the local minima of the coarse search, best first, to be refined by refine_axis.
struct PolynomialSeeds {
  static constexpr std::size_t kGraphSeeds = 3;  ///< at most, for the models without arms
  static constexpr std::size_t kArmSeeds = 5;    ///< at most, for the models with arms
  /// The same where points are touches of their own: what may lie on either arm has about as many
  /// minima again as strokes have, which hold their points on one.
  static constexpr std::size_t kLoneArmSeeds = 10;
  std::vector<AxisFit> parabola;
  std::vector<AxisFit> cubical_parabola;
  std::vector<AxisFit> semi_cubical_parabola;
  std::vector<AxisFit> cubic_spline;
};

/// For a trial direction of the axis the parabola and the cubical parabola are graphs y(x) with
/// linear coefficients. O(directions * points).
void add_graph_seeds(std::span<const FitPoint> points, PolynomialSeeds* seeds, WorkBudget& work);

/// For a trial direction and vertex abscissa x0, semi-cubical parabola and spline are linear in
/// t = +-sqrt(x - x0), given the arm (the sign of t) of each patch:
/// O(directions * vertices * (points + 2^patches)), with at most 2^3 arm patterns; patches beyond
/// the four longest take the arm that fits the curve through these better.
void add_arm_seeds(std::span<const FitPoint> points, std::span<const PatchSpan> patches,
                   PolynomialSeeds* seeds, WorkBudget& work);

}  // namespace palpate
