// Contact points as what they are before any class is named: smooth arcs under noise.
#pragma once

#include "core/recognition/samples/fit_data.h"
#include "core/recognition/smooth/smooth_model.h"

namespace palpate {

/// With fewer degrees of freedom than this the smooth model's residuals tell no noise: four leave
/// it a relative standard deviation of 1 / sqrt(2 * 4), 35 %.
inline constexpr int kFewestDegreesOfNoise = 4;

struct Arcs {
  FitData data;  ///< all points: noise and tangents set
  SmoothModel smooth;
  /// False: the noise is no better known than the smooth model's residuals tell it.
  bool sigma_known = true;
  double sigma = 0.0;  ///< noise of the typical point, normalised
};

/// `data` from make_fit_data. Points that bring no noise of their own get it from the residuals.
Arcs smooth_arcs(FitData data, bool sigma_known);

}  // namespace palpate
