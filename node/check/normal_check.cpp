#include "node/check/normal_check.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/local/noise.h"
#include "core/numerics/quantile.h"
#include "node/files/counted.h"
#include "node/files/quantity.h"

namespace palpate {
namespace {

/// The travel at a sample, by the chord between the samples around it.
struct Travel {
  Vec2 along = Vec2::Zero();
  double chord_m = 0.0;
  double turn_rad = 0.0;          ///< from its first half to its second
  bool is_in_the_middle = false;  ///< else at an end, where the chord is of one side alone
};

/// Measured normals beside the direction of travel.
struct NormalsSeen {
  std::size_t judged = 0;
  double along = 0.0;              ///< sum of |cosine| of the angle to the travel
  double into_material = 0.0;      ///< sum of cosines of the angle to where the material is stated
  std::size_t with_side = 0;       ///< judged where a side is stated
  std::size_t neighbours = 0;      ///< pairs whose travel goes on
  std::size_t opposed = 0;         ///< of these the pairs whose normals are opposed
  std::vector<double> off_rad;     ///< angles from across the travel
  std::vector<double> stated_rad;  ///< their deviations as stated
  std::vector<double> off_in_stated;  ///< angles, in all by which they may be off
};

std::optional<Travel> travel_at(const std::vector<Vec2>& positions, std::size_t i) {
  const std::size_t n = positions.size();
  // A chord of a tenth of the patch: noise hardly turns it, and the curve is not yet far from it.
  const std::size_t reach = std::max<std::size_t>(n / 20, 1);
  const Vec2 before = positions[i] - positions[i > reach ? i - reach : 0];
  const Vec2 after = positions[std::min(i + reach, n - 1)] - positions[i];
  const Vec2 chord = before + after;
  if (chord.isZero(0.0)) return std::nullopt;
  Travel travel;
  travel.chord_m = chord.norm();
  travel.along = chord / travel.chord_m;
  travel.turn_rad = std::abs(turn_between(before, after));
  travel.is_in_the_middle = i >= reach && i + reach < n;
  return travel;
}

/// Noise of a position: as stated, or as the samples scatter where that is more. 0 = not known. [m]
double noise_of(const CheckedPatch& patch) {
  const NoiseEstimate noise = estimate_noise(patch.positions);
  return std::max(patch.stated_sigma_m(), noise.status == LocalStatus::Ok ? noise.sigma_m : 0.0);
}

void look_at_angle(const CheckedNormal& measured, const Travel& travel, double noise_m,
                   NormalsSeen* seen) {
  if (!travel.is_in_the_middle || noise_m == 0.0) return;
  // Of the bend within its reach a chord misses the tangent in its middle by the change of
  // curvature alone: less than this part of the turn.
  constexpr double kOfTurn = 0.25;
  const double of_chord = std::sqrt(2.0) * noise_m / travel.chord_m + kOfTurn * travel.turn_rad;
  const double off = std::asin(std::min(std::abs(travel.along.dot(measured.normal)), 1.0));
  seen->off_rad.push_back(off);
  seen->stated_rad.push_back(measured.sigma_rad);
  seen->off_in_stated.push_back(off / (measured.sigma_rad + of_chord));
}

void look_at_normals(const CheckedPatch& patch, NormalsSeen* seen) {
  const std::size_t n = patch.normals.size();
  if (n < 2) return;
  const double noise_m = noise_of(patch);
  std::optional<Travel> before;
  double side_before = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const CheckedNormal& measured = patch.normals[i];
    const std::optional<Travel> travel =
        measured.normal.isZero(0.0) ? std::nullopt : travel_at(patch.positions, i);
    // Of 1 for straight to the left of the travel and -1 for straight to the right.
    const double side = travel ? left_of(travel->along).dot(measured.normal) : 0.0;
    if (travel && before) {
      // At a cusp the travel turns back.
      constexpr double kGoesOn = 0.5;
      const bool goes_on = travel->along.dot(before->along) > kGoesOn;
      seen->neighbours += goes_on ? 1 : 0;
      seen->opposed += goes_on && side * side_before < -kGoesOn ? 1 : 0;
    }
    before = travel;
    side_before = side;
    if (!travel) continue;
    ++seen->judged;
    seen->along += std::abs(travel->along.dot(measured.normal));
    look_at_angle(measured, *travel, noise_m, seen);
    if (patch.material_side == MaterialSide::Unspecified) continue;
    ++seen->with_side;
    seen->into_material += patch.material_side == MaterialSide::Left ? side : -side;
  }
}

std::string degrees_text(double rad) { return with_digits(rad * kDegrees, 2) + " degrees"; }

}  // namespace

void judge_normals(const std::string& probe, const std::vector<CheckedPatch>& patches,
                   std::vector<Finding>* findings) {
  NormalsSeen seen;
  for (const CheckedPatch& patch : patches) look_at_normals(patch, &seen);
  if (seen.judged == 0) return;
  // Between across the travel, where this is 0 but for noise, and along it, where it is 1.
  constexpr double kAlong = 0.7;
  constexpr double kInto = 0.5;          // of -1 for all right and 1 for all wrong
  constexpr double kMostOpposed = 0.02;  // of the neighbours, where single ones have failed
  // Half of normals that are as stated lie within 0.7 deviations.
  constexpr double kOff = 2.0;
  constexpr std::size_t kFewest = 6;  // of fewer, half are off by chance
  const bool is_off = seen.off_in_stated.size() >= kFewest && median_of(seen.off_in_stated) > kOff;
  if (seen.along > kAlong * static_cast<double>(seen.judged)) {
    findings->push_back({Severity::Error, probe, "the measured normals lie along the travel",
                         "normal_x and normal_y are the surface's normal in the frame of the "
                         "positions: are these tangents, or in a frame of the probe's own?",
                         true});
  } else if (seen.opposed > 0) {
    const bool are_few =
        static_cast<double>(seen.opposed) <= kMostOpposed * static_cast<double>(seen.neighbours);
    findings->push_back({are_few ? Severity::Warning : Severity::Error, probe,
                         "of " + std::to_string(seen.judged) + " measured normals, " +
                             counted(seen.opposed, "pair") + " of neighbours " +
                             (seen.opposed == 1 ? "points" : "point") + " to opposite sides",
                         "all normals point out of the material: along a stroke, to one side of it",
                         true});
  } else if (seen.into_material > kInto * static_cast<double>(seen.with_side)) {
    findings->push_back({Severity::Error, probe,
                         "the measured normals point to where material_side puts the material",
                         "normals point out of the material; material_side is that of the "
                         "direction of travel",
                         true});
  } else if (is_off) {
    findings->push_back({Severity::Warning, probe,
                         "half of " + std::to_string(seen.judged) +
                             " measured normals are more than " +
                             degrees_text(median_of(seen.off_rad)) +
                             " off from across the travel; they state a deviation of " +
                             degrees_text(median_of(seen.stated_rad)),
                         "are they in the frame of the positions, and normal_sigma_rad in "
                         "radians? Else state their deviation as it is",
                         true});
  } else {
    findings->push_back({Severity::Note, probe,
                         std::to_string(seen.judged) + " measured normals, across the travel",
                         "as it should be"});
  }
}

}  // namespace palpate
