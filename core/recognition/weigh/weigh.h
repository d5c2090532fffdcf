// From contact points to weighed hypotheses: one pass of the recognition.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/posterior/likelihood_of.h"
#include "core/recognition/posterior/posterior.h"
#include "core/recognition/samples/sample_memory.h"
#include "core/recognition/smooth/smooth_model.h"
#include "core/recognition/weigh/sided_start.h"

namespace palpate {

struct WeighOptions {
  unsigned classes = kAllClasses;  ///< classes to consider, by bit 1 << CurveClass
  /// Posterior probability needed for RECOGNIZED: a class that cannot prevent it is not refined.
  double recognized_probability = 0.95;
  double form_deviation_m = 0.0;   ///< as RecognizerOptions::form_deviation_m [m]
  bool unqualified_probe = false;  ///< as RecognizerOptions::unqualified_probe, decided
  /// Whether a smooth deviation from a class is one of the part, so that it is of no class. False
  /// if the probe may deviate so, or spikes that were not found.
  bool near_parts = true;
  TouchedFrom touched_from = TouchedFrom::Unknown;
  /// log odds against the gross errors of the touches that were set aside for the classes: those
  /// of "unclassified", which needs none, are higher by them.
  double log_odds_against_gross = 0.0;
  /// log of the evidence that parts near a class have on all touches, with those that were set
  /// aside, over that of free paths (Weighing::log_near_over_paths): to such a part none of them
  /// is gross.
  double log_near_with_gross = kNoEvidence;
  /// Of the weighings before; of this one afterwards. nullptr = nothing is kept.
  KeptSections* kept_sections = nullptr;
};

struct Weighing {
  FitData data;  ///< with noise and tangents set
  SmoothModel smooth;
  FitData reduced;   ///< the smooth model's reduced points, as the best class has the surface
  ClassFits coarse;  ///< on the reduced points
  ClassFits fits;    ///< plausible ones with chi-square of all points; the best refined on them
  /// Of the classes that are not negligible, and of the best in any case. The points are those of
  /// `data` if fits[i]->on_all, else the reduced points.
  ByClass<std::optional<CanonicalFit>> canonical;
  ClassProbabilities probabilities{};
  /// log of the evidence of all models together, up to a constant of the points and their noise.
  double log_evidence = kNoEvidence;
  /// log odds of "unclassified" over all classes, whatever their priors of shapes (posterior.h).
  double margin_of_unclassified = 0.0;
  /// Of touches that all lie apart: log of the evidence of parts near a class over that of free
  /// paths (near_parts.h).
  double log_near_over_paths = kNoEvidence;
  /// Share of the spline's posterior in its mode on the other side of c = 0.
  double rival_share = 0.0;
  /// Where nobody asked for a class that the best one is at one of its limits: whether that leaves
  /// as little as noise lets it. Then nothing tells the shape of the best one.
  bool limit_is_as_good = false;
  /// Of the best class on the reduced points, if it has any: input of moments_of_best().
  std::optional<ClassEvidence> best_evidence;
  std::optional<CanonicalFit> best_on_reduced;
  Likelihood stated;               ///< the likelihood before any deviation was seen
  ResidualExcess seen;             ///< of the best class
  bool unqualified_probe = false;  ///< WeighOptions::unqualified_probe
  /// Starts for the next weighing. The first belongs to `sides`.
  std::vector<SidedStart> starts;
  /// For each patch, the assumed side of travel on which the tip centres lie (tip_sides.h).
  std::vector<int> sides;
  /// SidedFits::margin of the sides taken.
  double sides_margin = 0.0;
  bool sides_against_normals = false;          ///< SidedFits::against_normals
  CurveClass best = CurveClass::Unclassified;  ///< the most probable, "unclassified" included
  double sigma = 0.0;                          ///< noise of the typical point, normalised
  /// Factor on covariances: correlation, misfit, few residuals and stated form error.
  double inflation = 1.0;
  double counted_chi2 = 0.0;  ///< chi-square of `best` for the misfit test (misfit_of)
  /// Of which each class's chi-square is the sum of squares: of `data`, of the best also normals
  /// along strokes (best_in_full.h).
  ByClass<std::size_t> residuals{};
};

/// `data`: from make_fit_data. Follows core/README.md, "Refinement and the bound" and "The
/// posterior". `starts`: those of an earlier weighing of fewer samples of the same patches, or
/// empty.
Weighing weigh(FitData data, std::span<const StoredPatch> patches, WorkBudget& work,
               const WeighOptions& options = {}, std::span<const SidedStart> starts = {});

}  // namespace palpate
