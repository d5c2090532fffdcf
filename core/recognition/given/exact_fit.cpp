#include "core/recognition/given/exact_fit.h"

#include <algorithm>
#include <span>
#include <vector>

#include "core/recognition/given/foot_weights.h"
#include "core/recognition/given/placed/foot_parameter.h"
#include "core/recognition/given/placed/stroke_feet.h"

namespace palpate {

PlacedCurve<DoubleDouble> exact_of(const PlacedCurve<double>& curve) {
  PlacedCurve<DoubleDouble> exact;
  exact.curve_class = curve.curve_class;
  for (int i = 0; i < 3; ++i) {
    exact.shape[i] = DoubleDouble(curve.shape[i]);
  }
  exact.origin = as<DoubleDouble>(curve.origin);
  exact.axis = as<DoubleDouble>(curve.axis);
  exact.axis = DoubleDouble(1.0) / sqrt(inner(exact.axis, exact.axis)) * exact.axis;
  for (const PlaneVector<double>& foot : curve.feet) {
    exact.feet.push_back(as<DoubleDouble>(foot));
  }
  if (curve.curve_class == CurveClass::Circle || curve.curve_class == CurveClass::Ellipse) {
    for (PlaneVector<DoubleDouble>& foot : exact.feet) {
      foot = DoubleDouble(1.0) / sqrt(inner(foot, foot)) * foot;
    }
  }
  return exact;
}

PlacedCurve<double> rounded(const PlacedCurve<DoubleDouble>& exact) {
  PlacedCurve<double> curve;
  curve.curve_class = exact.curve_class;
  for (int i = 0; i < 3; ++i) {
    curve.shape[i] = to_double(exact.shape[i]);
  }
  curve.origin = as_double(exact.origin);
  curve.axis = as_double(exact.axis);
  for (const PlaneVector<DoubleDouble>& foot : exact.feet) {
    curve.feet.push_back(as_double(foot));
  }
  return curve;
}

ExactFit exact_fit(const GivenCandidate& found, const LocalPoints& local, const GivenNoise& noise) {
  ExactFit fit;
  PlacedCurve<DoubleDouble>& placed = fit.placed;
  placed = exact_of(found.curve);
  std::vector<WeighedPoint<DoubleDouble>> exact = local.exact;
  for (WeighedPoint<DoubleDouble>& point : exact) {
    point.offset = DoubleDouble(static_cast<double>(found.side)) * point.offset;
  }
  // Newton converges quadratically: after a step that moves residuals by 1e-17, the next one is
  // below the rounding of a double.
  constexpr DescentEffort kToRounding{40, 1e-17, 1e-6};
  // Feet move along with the curve. A step from where no descent has come to an end may be so long
  // that feet of a stroke come to other branches: that is no way down.
  const int jumps = jumps_of(found.curve, found.points);
  const bool has_strokes = std::any_of(found.points.begin(), found.points.end(),
                                       [](const auto& point) { return point.stroke != 0; });
  const auto seat = [&](PlacedCurve<DoubleDouble>* trial) {
    if (!curve_of(*trial)) {
      return false;
    }
    if (!has_strokes) {
      return true;
    }
    half_squares(trial, std::span<const WeighedPoint<DoubleDouble>>(exact));
    return jumps_of(rounded(*trial), found.points) <= jumps;
  };
  fit.descent =
      descend(&placed, std::span<const WeighedPoint<DoubleDouble>>(exact), kToRounding, seat);
  if (noise.stated) {
    // Each round reduces the error of the weights by about noise / radius of curvature.
    constexpr int kMostRounds = 40;
    constexpr double kSame = 1e-14;
    for (int round = 0; round < kMostRounds; ++round) {
      if (weigh_at_feet(placed, local, noise.points, noise.default_sigma_m, &exact) <= kSame) {
        break;
      }
      fit.descent =
          descend(&placed, std::span<const WeighedPoint<DoubleDouble>>(exact), kToRounding, seat);
    }
  }
  return fit;
}

}  // namespace palpate
