// The classes as they are with the tips on given sides, and the one that this stands or falls with.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/posterior/edges.h"
#include "core/recognition/posterior/evidences.h"
#include "core/recognition/posterior/laplace_evidences.h"
#include "core/recognition/smooth/arcs.h"
#include "core/recognition/weigh/sided_start.h"

namespace palpate {

/// The classes fitted for one choice of the tips' sides.
struct SideChoice {
  /// For each patch, the side of travel on which the tip centres lie (tip_sides.h).
  std::vector<int> sides;
  bool expected = false;    ///< outside the bends, or where TouchedFrom says
  bool contrary = false;    ///< the other of the two
  bool along_told = false;  ///< fitted along directions that are told (SideContext)
  ClassFits fits;           ///< of every class, to `reduced`
  FitData reduced;          ///< the arcs' reduced points, moved to the surface
  CurveClass candidate = CurveClass::Unclassified;
  std::optional<ClassFit> settled;  ///< the candidate at its optimum on the reduced points
  /// The candidate on all points, unless they agree with the reduced points; nullopt where it is no
  /// such curve there, or has tips on other sides: centres show theirs whichever were assumed.
  std::optional<ClassFit> refined;
  /// Of free paths and what was known of modes before; of the classes, once a candidate is taken.
  Evidences evidences;
  /// log of the evidence of the candidate, however free-form paths fare beside it; -infinity where
  /// it is on no points.
  double log_evidence = -std::numeric_limits<double>::infinity();
  double log_of_normals = 0.0;  ///< log_likelihood_of_normals of the sides
};

/// What the choices of sides are compared by.
struct SideContext {
  const Arcs& arcs;
  const Likelihood& likelihood;
  WorkBudget& work;
  Evidences of_paths;              ///< with that of free-form paths, under this law
  unsigned classes = kAllClasses;  ///< by bit 1 << CurveClass
  /// As in fit_classes(), for all sides.
  double out_of_reach = std::numeric_limits<double>::infinity();
  TouchedFrom touched_from = TouchedFrom::Unknown;
  const Edges* edges = nullptr;  ///< that the tips' centres lie on; nullptr if none are
  /// The directions are those of a curve that all points lie on as noise lets them: what not all
  /// points have knows none better.
  bool directions_told = false;
};

/// The classes as fit_classes() has them, with the more probable cusp (probable_cusp.h).
ClassFits fit_classes_to(const FitData& reduced, const WarmStart* start, const SideContext& by,
                         double out_of_reach);

/// The classes followed from where they were with the tips on these sides, or sought.
ClassFits fit_classes_from(std::span<const SidedStart> starts, std::span<const int> sides,
                           const FitData& reduced, const SideContext& by,
                           double out_of_reach = std::numeric_limits<double>::infinity());

/// The class that a choice stands or falls with, by the evidence of all, and its optimum on the
/// reduced points. Returns whether it is another than before.
bool settle_candidate(const SideContext& by, ModesOf modes, SideChoice* choice);

/// The same, and on all points. What was refined before is not once more.
void take_candidate(const SideContext& by, ModesOf modes, SideChoice* choice);

/// The choice of these sides with these fits to these points, its candidate taken by their modes.
SideChoice choice_of(std::span<const int> sides, ClassFits fits, FitData reduced,
                     const SideContext& by);

/// Of chi-square: what changes odds less than tenfold, where it is what noise leaves. What leaves
/// more has its odds by a noise that is as large as its residuals.
double agreement(double chi2, const SmoothModel& smooth);

/// By how much the reduced points, tips taken off, tell another chi-square of the candidate than
/// all points do; infinite if it is no curve on all points.
double disagreement(const SideChoice& choice, const SmoothModel& smooth);

/// Whether the reduced points tell of the candidate what all points do.
bool agrees(const SideChoice& choice, const SmoothModel& smooth);

/// Whether all points have the candidate, as far as noise lets them.
bool fits_all(const SideChoice& choice, const SideContext& by);

/// What the candidate leaves, on the reduced points with their directions or on all without.
double least_left(const SideChoice& choice, const SmoothModel& smooth);

/// log of the evidence of the candidate, however free-form paths fare beside it: choices are
/// compared with one another. A part whose walls are two curves that differ by little more than
/// coherent errors may is told no better than these are known.
double log_evidence_of(const SideChoice& choice, const SideContext& by);

}  // namespace palpate
