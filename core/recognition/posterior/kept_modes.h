// Modes that the priors led to, kept for the next weighing of the same object.
#pragma once

#include <vector>

#include "core/numerics/work_budget.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/posterior/evidences.h"

namespace palpate {

/// The mode of one class, in the frame of the points that it was found on.
struct KeptMode {
  Chart chart;
  TouchedShape shape;
  Pose2 frame_T_curve;
  std::vector<double> t;       ///< feet of the points
  double log_mass = 0.0;       ///< about it, by Laplace's formula
  double log_all_modes = 0.0;  ///< ClassEvidence's
  double fitted_chi2 = 0.0;    ///< ClassEvidence's
};

struct KeptModes {
  std::vector<KeptMode> modes;
  std::vector<Vec2> points;  ///< normalised
  Pose2 frame;               ///< FitData's frame of these points
  double scale = 1.0;        ///< FitData's scale of these points [m]
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
