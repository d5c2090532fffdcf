// Modes that the priors led to, kept for the next weighing of the same object.
#pragma once

#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/posterior/evidences.h"

namespace palpate {

/// The mode of one class.
struct KeptMode {
  CanonicalPlace place;
  bool as_arc = false;         ///< Touch::as_arc
  std::vector<double> t;       ///< feet of the points, in the canonical frame
  double log_mass = 0.0;       ///< about it, by Laplace's formula
  double log_all_modes = 0.0;  ///< ClassEvidence's
  double fitted_chi2 = 0.0;    ///< ClassEvidence's
};

struct KeptModes {
  std::vector<KeptMode> modes;
  std::vector<Vec2> points_m;  ///< that they were found on, in the world
};

/// The modes of the classes whose priors were asked for one. None of points with measured normals,
/// whose weights belong to a fit.
KeptModes kept_modes(const Evidences& evidences, const FitData& reduced);

/// The evidences at these modes on `reduced`, where a few samples have come to: each is followed
/// from where it was. One that has lost against its class's fit is left out, so that it is sought
/// again. `fits`: to `reduced`.
std::vector<ClassEvidence> carried_modes(const KeptModes& kept, const ClassFits& fits,
                                         const FitData& reduced, double inflation,
                                         WorkBudget& work);

}  // namespace palpate
