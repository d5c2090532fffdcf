// "Unclassified" as two straight edges that meet in a fillet: the part that strokes over an edge
// show most often.
#pragma once

#include <optional>

#include "core/curves/rounded_corner.h"
#include "core/numerics/work_budget.h"
#include "core/recognition/smooth/arcs.h"

namespace palpate {

/// Coordinates that the data may determine: of edges and arc.
inline constexpr int kEdgesCoordinates = 5;

struct Edges {
  RoundedCorner corner;  ///< of the points as they are: of a tip's centres, if these are given
  double chi2 = 0.0;     ///< of all points
  /// Of the corner's centre, bisector, half turn and log radius.
  Eigen::Matrix<double, kEdgesCoordinates, kEdgesCoordinates> information;
};

/// The edges that all points lie on best. `out_of_reach`: chi-square of the reduced points above
/// which they change no answer. nullopt if no two directions of the strokes differ, if tips of
/// different radii or measured normals are among the points, or if no edges are within reach.
/// O(points).
std::optional<Edges> edges_of(const Arcs& arcs, double out_of_reach, WorkBudget& work);

/// log of what the prior leaves of the likelihood, with so many times the variances of the noise.
double log_occam_of(const Edges& edges, double inflation);

}  // namespace palpate
