// Searches the curves of a given class that all points are near to, in double precision.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "core/recognition/given/local_points.h"
#include "core/recognition/given/placed/descent.h"

namespace palpate {

/// So many deviations of a normal law the truth is hardly ever off: once in 370 cases.
inline constexpr double kReach = 3.0;

struct GivenCandidate {
  PlacedCurve<double> curve;
  double cost = std::numeric_limits<double>::infinity();
  /// -log likelihood, up to a constant: the cost, less the logarithms of the weights, which a
  /// covariance or a normal has at the feet of this curve.
  double misfit = std::numeric_limits<double>::infinity();
  bool settled = false;  ///< at a minimum
  int side = 0;  ///< side of the curve on which tip centres lie (+1 left, -1 right); 0 without tips
  /// With tips: all feet are on the arm where t has this sign, though the other arm may be nearer.
  /// A part may end before its curve comes to the cusp. 0: every foot is the nearest one.
  int arm = 0;
  std::vector<WeighedPoint<double>> points = {};  ///< all of them, with the weights at this curve
};

/// What the search is to know of the points beside their places.
struct GivenNoise {
  std::span<const GivenPoint> points;  ///< all, also those set aside
  double default_sigma_m = 0.0;
  bool stated = false;  ///< the noise of every point is known
};

/// Descends from the candidate's curve, and sets its cost and whether it settled. Every foot is the
/// nearest one, or moves along the arm that the candidate keeps to.
void descend_on(std::span<const WeighedPoint<double>> points, const DescentEffort& effort,
                GivenCandidate* candidate);

/// Descends from the candidate's curve on all points, with the weights at its feet.
void settle(const LocalPoints& local, const GivenNoise& noise, GivenCandidate* candidate,
            const HeldUnknowns& held = {});

/// The sides of the curve on which tips may lie.
std::vector<int> sides_of(std::span<const GivenPoint> points);

/// True if the first is to be preferred: it has the lower misfit. A minimum has priority over a
/// valley in which no descent has come to an end, as long as noise can be what makes it worse.
bool is_better(const GivenCandidate& u, const GivenCandidate& v);

/// All minima that any start leads to, with tips on either side, and valleys without a minimum. The
/// better ones come first. Their feet are those of all points.
std::vector<GivenCandidate> search_minima(CurveClass curve_class, const LocalPoints& local,
                                          const GivenNoise& noise);

}  // namespace palpate
