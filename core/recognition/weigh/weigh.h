// From contact points to weighed hypotheses: one pass of the recognition.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/fit/warm_start.h"
#include "core/recognition/posterior/posterior.h"
#include "core/recognition/samples/sample_memory.h"
#include "core/recognition/smooth/smooth_model.h"

namespace palpate {

struct WeighOptions {
  unsigned classes = kAllClasses;  ///< to consider, by bit 1 << CurveClass
  /// What an answer needs to be RECOGNIZED: what cannot keep it from that is not refined.
  double recognized_probability = 0.95;
  double form_deviation_m = 0.0;   ///< as RecognizerOptions::form_deviation_m
  bool unqualified_probe = false;  ///< likewise
};

struct Weighing {
  FitData data;  ///< noise set, tangents set
  SmoothModel smooth;
  FitData reduced;   ///< the smooth model's reduced points, taken to the surface
  ClassFits coarse;  ///< on them
  ClassFits fits;    ///< plausible ones weighed on all points, the best refined there
  /// Of what is not negligible; the points are those of `data` where fits[i]->on_all, otherwise the
  /// reduced ones.
  std::array<std::optional<CanonicalFit>, 9> canonical;
  ClassProbabilities probabilities{};
  /// log odds of "unclassified" over all classes, whatever is expected of their shapes.
  double margin_of_unclassified = 0.0;
  /// Of the spline's posterior, that its mode on the other side of c = 0 has.
  double rival_share = 0.0;
  /// Of the best class on the reduced points, if it has any: what its moments are taken from
  /// (best_moments.h).
  std::optional<ClassEvidence> best_evidence;
  std::optional<CanonicalFit> best_on_reduced;
  Likelihood stated;        ///< before any deviation was seen
  bool correlated = false;  ///< neighbours may err together
  /// For the next weighing; the first is that of `sides`.
  std::vector<SidedStart> starts;
  /// Per patch the side of travel on which the tip centres were taken to lie (tip_sides.h).
  std::vector<int> sides;
  /// log odds over the next best way for them to lie, priors included; infinite where the probes
  /// told.
  double sides_margin = 0.0;
  CurveClass best = CurveClass::Unclassified;  ///< most probable, "unclassified" included
  double sigma = 0.0;                          ///< noise of the typical point, normalised
  /// What covariances are to be multiplied with: correlation, misfit and stated form error.
  double inflation = 1.0;
  double noise_inflation = 1.0;     ///< of it, without the stated form error
  double white_variance = 1.0;      ///< of the noise, in units of sigma^2
  double counted_chi2 = 0.0;        ///< of `best`, with what may be stated form error tempered
  double correlation_length = 0.0;  ///< normalised; 0 = white
};

/// `data` from make_fit_data. Follows core/README.md, "Refinement and the bound" and "Evidence".
/// Where `work` is spent, it says what has been found by then.
/// `starts`: what an earlier weighing of fewer samples of the same patches left, or nothing.
Weighing weigh(FitData data, bool sigma_known, std::span<const StoredPatch> patches,
               WorkBudget& work, const WeighOptions& options = {},
               std::span<const SidedStart> starts = {});

}  // namespace palpate
