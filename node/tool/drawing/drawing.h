// The contents of a picture of a recognition, in metres. `palpate view` and `fit --plot` both use
// it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "node/tool/contact_groups.h"
#include "node/tool/drawing/curve_band.h"
#include "node/tool/drawing/curve_model.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate {

/// One point of the drawn curve.
struct CurvePlace {
  double t = 0.0;
  Vec2 position;
  Vec2 left;                      ///< unit normal, to the left of increasing t
  double arc_m = 0.0;             ///< length of the chords from the first point
  std::optional<BandWidth> band;  ///< 95 %
  // Only with Curvature::Along:
  double kappa = 0.0;    ///< signed by increasing t; not finite at a cusp [1/m]
  double kappa_s = 0.0;  ///< [1/m^2]
  std::optional<double> kappa_sigma;
};

/// The most probable curve, or a rival of it (without band).
struct DrawnCurve {
  v1::CurveClass curve_class = v1::CURVE_CLASS_UNSPECIFIED;
  double probability = 0.0;
  bool closed = false;
  std::vector<CurvePlace> places;
};

/// The largest distance of a border of the band from the curve; 0 without a band.
double widest_band_m(const DrawnCurve& curve);

/// Local geometry of a touched place, with its position along the curve.
struct DrawnContact {
  const v1::LocalizedContact* contact = nullptr;
  double arc_m =
      0.0;  ///< along the drawn curve; without one, along the straight lines between contacts
  /// Signed by increasing t, as the curve's: for a stroke in the other direction the sign is
  /// changed. [1/m]
  double kappa = 0.0;
};

struct Drawing {
  std::optional<DrawnCurve> curve;
  std::vector<DrawnCurve> rivals;  ///< most probable first
  std::vector<DrawnContact> contacts;
};

/// Only charts need the curvature, and its deviation takes most of the time of a drawing.
enum class Curvature { Along, None };

/// The drawing refers to contacts of `answer`, which must outlive it.
Drawing make_drawing(const ContactGroup& group, const v1::Recognition& answer, Curvature curvature);

/// Residual of one sample from the curve.
struct SampleResidual {
  double t = 0.0;  ///< of the foot point
  /// Positive to the left of the curve; less the radius for a tip's centre.
  double residual_m = 0.0;
  bool is_far = false;  ///< beyond kFarSigmas
};

/// Samples farther from the curve than this are drawn as spikes. Noise alone leaves 6 of 10 million
/// beyond it.
inline constexpr double kFarSigmas = 5.0;

/// Residuals of the samples of a run from the curve. `sigma_m`: noise of samples that state none.
std::vector<SampleResidual> residuals_of(const CurveModel& model, const ContactRun& run,
                                         double sigma_m);

}  // namespace palpate
