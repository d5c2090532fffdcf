// What a picture of a recognition shows, in metres: the one source of palpate view and of fit
// --plot.
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

/// One place of the drawn curve.
struct CurvePlace {
  double t = 0.0;
  Vec2 position;
  Vec2 left;                      ///< unit normal, to the left of increasing t
  double arc_m = 0.0;             ///< arc length from the first place, by chords
  std::optional<BandWidth> band;  ///< 95 %
  // With Curvature::Along:
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

/// Local geometry of a touched place beside the curve's.
struct DrawnContact {
  const v1::LocalizedContact* contact = nullptr;
  double arc_m =
      0.0;  ///< along the drawn curve; without one, along the straight lines between contacts
  /// Signed by increasing t, as the curve's: a stroke the other way turns kappa's sign. [1/m]
  double kappa = 0.0;
};

struct Drawing {
  std::optional<DrawnCurve> curve;
  std::vector<DrawnCurve> rivals;  ///< most probable first
  std::vector<DrawnContact> contacts;
};

/// Only charts show the curvature, and its deviations are most of a drawing's work.
enum class Curvature { Along, None };

/// Views contacts of `answer`, which must outlive it.
Drawing make_drawing(const ContactGroup& group, const v1::Recognition& answer, Curvature curvature);

/// What a sample leaves beside the curve.
struct SampleResidual {
  double t = 0.0;           ///< of its foot
  double residual_m = 0.0;  ///< to the curve's left; for a tip's centre, beyond its radius
  bool is_far = false;      ///< beyond kFarSigmas
};

/// Samples further from the curve than this are drawn as spikes: noise alone leaves 6 of 10
/// million.
inline constexpr double kFarSigmas = 5.0;

/// Residuals of a run from a curve; `sigma_m` is the noise of samples that bring none.
std::vector<SampleResidual> residuals_of(const CurveModel& model, const ContactRun& run,
                                         double sigma_m);

}  // namespace palpate
