// The evidence of a class: its likelihood averaged over its prior.
#pragma once

#include <optional>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/modes/touched_curve.h"

namespace palpate {

/// A curve of the class and its share of the posterior.
struct PosteriorNode {
  TouchedCurve curve;
  double weight = 1.0;  ///< the weights of all nodes of a mode sum to 1
};

/// One mode of a class: an optimum and its surroundings.
struct ClassEvidence {
  Touch touch;
  double fitted_chi2 = 0.0;  ///< chi-square at the optimum of the likelihood
  /// log of (evidence / likelihood at the optimum): what the prior leaves of the likelihood.
  double log_occam = 0.0;
  /// log of (mass of all modes / mass of this one): arms that no path joins (prior_starts.h).
  double log_all_modes = 0.0;
  bool prior_mode_sought = false;
  /// `fitted_chi2` is that of the class's limit (class_limits.h), not of a fit of its own.
  bool counted_from_limit = false;
  /// `log_occam` if all of the prior were at this shape: only place and direction of the touch
  /// remain, whose cost is the same for every curve.
  double log_occam_of_touch = 0.0;
  /// Number of coordinates that the data determine rather than the prior.
  double determined = 0.0;
  /// log of (prior density at the mode / prior density at its centre).
  double log_prior = 0.0;
  /// Slices along the coordinate that the data leave widest. A single node if the model is linear
  /// over the whole posterior.
  std::vector<PosteriorNode> nodes;
  std::size_t mode = 0;  ///< index of the node at the optimum of likelihood times prior
  int widest = -1;       ///< the sliced coordinate; -1 with one node
};

/// log: a mode of less than a fiftieth of the best is not told.
inline constexpr double kToldMass = 4.0;

/// Puts the evidence at a mode, by Laplace's formula: the only one, until others are told of.
void set_mode(TouchedCurve mode, ClassEvidence* evidence);

/// `log_all`: its log_all_modes from now on.
void set_log_all_modes(double log_all, ClassEvidence* evidence);

/// False if the prior seems to leave more than all of the likelihood: then the fit was not at its
/// optimum.
bool is_of_optimum(const ClassEvidence& evidence);

/// By how much less chi-square the mode leaves than the fit that `log_occam` counts from, which
/// then was not the optimum; else 0.
double fall_to_mode(const ClassEvidence& evidence);

/// The evidence by Laplace's formula, a normal law about the optimum. `fit` must be at its optimum
/// on `data`, the reduced points as surface points, with one point for each. Noise variances are
/// multiplied by `inflation`. nullopt if double precision cannot hold the fit in canonical
/// coordinates, nor a spline's as an arc: a vertex so far away has no share in the prior.
/// O(points).
std::optional<ClassEvidence> evidence_of(const CanonicalFit& fit, const FitData& data,
                                         double inflation, WorkBudget& work);

/// The evidence at the mode that `start`, which need not be an optimum, leads to. `fitted_chi2`:
/// the chi-square that `log_occam` counts from. nullopt as for evidence_of().
std::optional<ClassEvidence> at_mode(const CanonicalFit& start, bool as_arc, double fitted_chi2,
                                     const FitData& data, double inflation, WorkBudget& work);

/// The evidence at the mode of `before`, if it is larger. `before`: from another fit of the class
/// to the same data, with the same inflation.
ClassEvidence at_better_mode(ClassEvidence evidence, const ClassEvidence& before);

/// The same mode's evidence by Laplace's formula, counted from another `fitted_chi2`.
ClassEvidence counted_from(double fitted_chi2, ClassEvidence evidence);

}  // namespace palpate
