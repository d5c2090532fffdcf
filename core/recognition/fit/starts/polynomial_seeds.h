// Starting points for the polynomial classes: an exhaustive coarse search. It needs neither kappa_s
// nor the order of the patches nor their directions of travel.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/starts/axis_fit.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// For each model the local minima of the coarse search, best first, to be refined by refine_axis.
struct PolynomialSeeds {
  static constexpr std::size_t kGraphSeeds = 3;  ///< most seeds of a graph model
  static constexpr std::size_t kArmSeeds = 5;    ///< most seeds of an arm model
  /// The same if the points are single touches. Each may lie on either arm, so that there are about
  /// twice as many minima as with strokes, whose points lie on one arm.
  static constexpr std::size_t kLoneArmSeeds = 10;
  /// The same of few touches, which leave more valleys still.
  static constexpr std::size_t kFewTouchesSeeds = 20;
  /// Splines more, for where nothing fits. Two or three strokes on the flanks of a loop leave 10 to
  /// 18 minima, and the true one is among the first eleven (spline_flanks_test).
  static constexpr std::size_t kMoreSplines = 6;
  std::vector<AxisFit> parabola;
  std::vector<AxisFit> cubical_parabola;
  std::vector<AxisFit> semi_cubical_parabola;
  std::vector<AxisFit> cubic_spline;
  std::vector<AxisFit> more_splines;  ///< the next minima
};

/// Five for each unknown of a spline. The more touches there are, the farther above the right arms'
/// valley those of wrong arms end, and the better four of them show the others' arms.
std::size_t most_few_touches();

/// Whether the points are touches one at a time, and so few that any may lie on either arm of a
/// curve through the others: each pattern of arms then has valleys of its own.
bool are_few_touches(std::span<const FitPoint> points, std::span<const PatchSpan> patches);

/// Seeds of parabola and cubical parabola. For a trial direction of the axis they are graphs y(x)
/// with linear coefficients. O(directions * points).
void add_graph_seeds(std::span<const FitPoint> points, PolynomialSeeds* seeds, WorkBudget& work);

/// Seeds of semi-cubical parabola and spline. For a trial direction and vertex abscissa x0 they are
/// linear in t = +-sqrt(x - x0), given the arm (the sign of t) of each patch. O(directions *
/// vertices * (points + 2^patches)), with at most 2^3 patterns of arms: patches beyond the four
/// longest take the arm that fits the curve through these better. Of few touches all arms are then
/// chosen once more, and splines with other arms than those of the minima are appended.
void add_arm_seeds(std::span<const FitPoint> points, std::span<const PatchSpan> patches,
                   PolynomialSeeds* seeds, WorkBudget& work);

/// The one start of the arm models where all points lie on a line: an arm along it, with the vertex
/// a span of the points away. Every other arm that is as straight there leads to as good a fit.
void add_straight_arm(std::span<const FitPoint> points, PolynomialSeeds* seeds);

}  // namespace palpate
