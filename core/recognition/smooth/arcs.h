// Contact points before any class is known: smooth arcs with noise.
#pragma once

#include "core/recognition/samples/fit_data.h"
#include "core/recognition/smooth/smooth_model.h"

namespace palpate {

/// Fewest degrees of freedom for which what a class leaves gives a noise: four leave it a relative
/// standard deviation of 1 / sqrt(2 * 4), 35 %.
inline constexpr int kFewestDegreesOfNoise = 4;

struct Arcs {
  FitData data;  ///< all points, with noise and tangents set
  SmoothModel smooth;
  /// False if the noise is only estimated, from the smooth model's residuals.
  bool sigma_known = true;
  double sigma = 0.0;  ///< root mean square noise of the points, normalised
  /// Sections that leave more than the noise, stated or what a class shows, have not been cut.
  bool may_not_follow = false;
  /// The readings are rounded, and nothing but a class can show whether by more than they scatter:
  /// touches one at a time (arcs_of_rounding).
  bool may_be_rounding = false;
};

/// The arcs with what rounding leaves for their noise, which is known then.
Arcs arcs_of_rounding(Arcs arcs);

/// The arcs with sections that leave more than the stated noise cut until they do not, or taken for
/// points. `arcs`: of stated noise.
Arcs arcs_of_stated_noise(Arcs arcs);

/// The same where nobody states the noise, by so many times the noise that the sections have shown.
Arcs arcs_of_noise(Arcs arcs, double times);

/// The same arcs with so many times the noise, whose size stays unknown.
Arcs arcs_in_units_of(Arcs arcs, double times);

/// Whether the noise is neither stated nor shown by the sections.
bool is_noise_unseen(const Arcs& arcs);

/// Fits the smooth model. `data`: from make_fit_data. If the noise is not stated, sets it from the
/// model's residuals. `source`: fit_smooth_model's.
Arcs smooth_arcs(FitData data, const SectionSource& source = {});

}  // namespace palpate
