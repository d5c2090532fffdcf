// A weighing, and which samples it is of.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/curves/pose2.h"
#include "core/curves/shape_parameters.h"
#include "core/recognition/samples/stored_patch.h"
#include "core/recognition/weigh/weigh.h"

namespace palpate {

/// A curve, and the noise about it that leaves a sample on it.
struct ExplainingCurve {
  ShapeParameters shape;
  Pose2 world_T_curve;
  double noise_m = 0.0;
};

struct Weighed {
  Weighing w;
  std::vector<bool> outliers;  ///< one flag per sample of the patches; empty where there are none
  /// Where these are others than were asked about.
  std::optional<std::vector<StoredPatch>> patches;
  bool leaves_class = false;  ///< FarSamples::are_form
  /// Of the best class, where `patches` have spikes that it explains.
  std::optional<ExplainingCurve> explains = {};
};

/// The patches that a weighing is of, which asked about these.
std::span<const StoredPatch> patches_of(const Weighed& weighed, std::span<const StoredPatch> asked);

/// Of a sample from the curve, or of a tip's centre from where it would touch it; the sign tells
/// the side. [m]
double signed_distance_m(const ExplainingCurve& from, const StoredSample& sample,
                         double tip_radius_m);

/// Likewise, without a sign. [m]
double distance_m(const ExplainingCurve& from, const StoredSample& sample, double tip_radius_m);

/// Noise of a sample: as stated, or else the curve's. [m]
double noise_m(const ExplainingCurve& about, const StoredSample& sample);

/// White noise of a typical sample; if estimated, from the best class's residuals. [m]
double residual_noise_m(const Weighing& weighing);

/// nullopt where double precision cannot hold it.
std::optional<ExplainingCurve> curve_of(const CanonicalFit& fit, double noise_m);

/// The best class's; nullopt where there is none, or as above.
std::optional<ExplainingCurve> curve_of(const Weighing& weighing);

}  // namespace palpate
