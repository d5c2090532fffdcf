// The marginal likelihood of a class: its likelihood, averaged over its prior.
#pragma once

#include <optional>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/posterior/touched_curve.h"

namespace palpate {

/// A curve of the class and the share of its posterior that it stands for.
struct PosteriorNode {
  TouchedCurve curve;
  double weight = 1.0;  ///< of all nodes of a mode: 1
};

/// One mode of a class: an optimum and what lies around it.
struct ClassEvidence {
  Touch touch;
  double fitted_chi2 = 0.0;  ///< of the optimum of the likelihood
  /// log of the marginal likelihood over the likelihood at the optimum: what the prior leaves of
  /// it.
  double log_occam = 0.0;
  /// Of that, what lies about the mode.
  double log_occam_of_mode = 0.0;
  /// log of the evidence over a line's, where that was asked (straight_paths.h).
  std::optional<double> log_over_line;
  bool prior_mode_sought = false;
  /// The same with all of the prior at this shape: what is left is what the place and direction of
  /// the touch cost every curve.
  double log_occam_of_touch = 0.0;
  /// How many coordinates the data determine rather than the prior.
  double determined = 0.0;
  /// log of the prior's density there over that at its centre.
  double log_prior = 0.0;
  /// Slices along the coordinate that the data leave the widest; one node where the model is linear
  /// over all that they leave.
  std::vector<PosteriorNode> nodes;
  std::size_t mode = 0;  ///< of the nodes, the optimum of likelihood times prior
  int widest = -1;       ///< that coordinate; -1 with one node
};

/// A prior cannot leave more than all of the likelihood: with that, the fit was no optimum.
bool is_of_optimum(const ClassEvidence& evidence);

/// By Laplace's formula: a normal law about the optimum. `fit` is at its optimum on `data`, the
/// reduced points as surface points, and has a point for each. Noise variances count `inflation`
/// times. nullopt where the fit is no curve of its class in canonical coordinates in double
/// precision: a vertex so far away has no share in the prior. O(points).
std::optional<ClassEvidence> evidence_of(const CanonicalFit& fit, const FitData& data,
                                         double inflation, WorkBudget& work);

/// The same at the mode that the prior leads to, where that holds more, and more than `least`, the
/// log of what the prior leaves of the likelihood: a fit may be at an optimum of the likelihood far
/// out in the prior's tails, in a valley with a place of as good a fit that the prior expects, but
/// too long and too bent to be walked along. `evidence`: of one node.
ClassEvidence with_prior_mode(ClassEvidence evidence, const FitData& data, double least,
                              WorkBudget& work);

/// The same at the mode of `before`, where that holds more: another fit of the class to the same
/// data, at the same inflation.
ClassEvidence at_better_mode(ClassEvidence evidence, const ClassEvidence& before);

}  // namespace palpate
