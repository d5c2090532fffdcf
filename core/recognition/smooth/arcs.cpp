#include "core/recognition/smooth/arcs.h"

#include <algorithm>
#include <utility>

#include "core/recognition/smooth/across_noise.h"
#include "core/recognition/smooth/stroke_noise.h"

namespace palpate {
namespace {

/// Whether enough degrees of freedom are left to estimate the noise from.
bool shows_noise(const SmoothModel& smooth) { return smooth.dof() >= kDegreesThatShowNoise; }

/// Sets the noise of all points from the smooth model's residuals. Returns true if it is no larger
/// than rounding: then it counts as known.
bool set_noise(FitData* data, SmoothModel* smooth) {
  // With too few degrees of freedom there is no estimate.
  const double rounding = rounding_level(*data);
  const double estimate = shows_noise(*smooth) ? smooth->noise_ratio() : kExact;
  const double sigma = std::max(estimate, rounding);
  scale_noise(sigma, data, smooth);
  return estimate <= rounding;
}

/// Takes what rounding leaves for the noise.
void take_rounding(FitData* data, Arcs* arcs) {
  scale_noise(data->reading_noise / rms_sigma(*data), data, &arcs->smooth);
  arcs->smooth = fit_smooth_model(data, true);
  arcs->sigma_known = true;
  arcs->may_not_follow = false;
}

}  // namespace

Arcs arcs_of_rounding(Arcs arcs) {
  take_rounding(&arcs.data, &arcs);
  arcs.sigma = rms_sigma(arcs.data);
  arcs.may_be_rounding = false;
  return arcs;
}

Arcs arcs_of_stated_noise(Arcs arcs) {
  arcs.smooth = fit_smooth_model(&arcs.data, true, StatedNoise::Holds);
  arcs.may_not_follow = false;
  return arcs;
}

Arcs arcs_of_noise(Arcs arcs, double times) {
  scale_noise(times, &arcs.data, &arcs.smooth);
  arcs = arcs_of_stated_noise(std::move(arcs));
  arcs.sigma = rms_sigma(arcs.data);
  return arcs;
}

Arcs arcs_in_units_of(Arcs arcs, double times) {
  scale_noise(times, &arcs.data, &arcs.smooth);
  arcs.sigma = rms_sigma(arcs.data);
  return arcs;
}

bool is_noise_unseen(const Arcs& arcs) { return !arcs.sigma_known && !shows_noise(arcs.smooth); }

Arcs smooth_arcs(FitData data, const SectionSource& source) {
  Arcs arcs;
  const bool sigma_known = data.noise_is_stated;
  if (!sigma_known) {
    weigh_strokes(&data);
  }
  arcs.smooth = has_covariances(data)
                    ? smooth_across(sigma_known, source, &data)
                    : fit_smooth_model(&data, sigma_known, StatedNoise::MayBeTooLow, source);
  arcs.sigma_known = sigma_known || set_noise(&data, &arcs.smooth);
  arcs.may_not_follow = sigma_known || !arcs.sigma_known;
  if (!sigma_known && rms_sigma(data) < data.reading_noise) {
    arcs.may_be_rounding = !shows_noise(arcs.smooth);
    if (!arcs.may_be_rounding) {
      // Sections may follow rounded readings to the last digit, from step to step.
      const std::size_t before = arcs.smooth.fitted;
      take_rounding(&data, &arcs);
      arcs.smooth.fitted += before;
    }
  }
  arcs.sigma = rms_sigma(data);
  arcs.data = std::move(data);
  return arcs;
}

}  // namespace palpate
