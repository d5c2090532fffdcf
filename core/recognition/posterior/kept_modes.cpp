#include "core/recognition/posterior/kept_modes.h"

#include <limits>
#include <span>
#include <utility>

#include "core/recognition/modes/mode_search.h"
#include "core/recognition/posterior/prior_modes.h"

namespace palpate {
namespace {

std::size_t nearest(const std::vector<Vec2>& points_m, const Vec2& place_m) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const double squared = (points_m[i] - place_m).squaredNorm();
    if (squared < least) {
      least = squared;
      best = i;
    }
  }
  return best;
}

/// For each point of `reduced`, the kept one that lies nearest. Strokes that have not grown leave
/// their points as they were, one after the other: only the others are compared with all.
std::vector<std::size_t> nearest_kept(const std::vector<Vec2>& kept_m, const FitData& reduced) {
  constexpr double kSame = 1e-9;  // of the half extent: far below any noise, above its rounding
  const double same_m = kSame * reduced.scale;
  std::vector<std::size_t> numbers;
  numbers.reserve(reduced.points.size());
  for (const FitPoint& point : reduced.points) {
    const Vec2 place_m = world_m(reduced, point);
    const std::size_t next = numbers.empty() ? 0 : numbers.back() + 1;
    const bool is_next = next < kept_m.size() && (kept_m[next] - place_m).norm() <= same_m;
    numbers.push_back(is_next ? next : nearest(kept_m, place_m));
  }
  return numbers;
}

/// nullopt where double precision does not hold the mode's vertex.
std::optional<KeptMode> kept(const ClassEvidence& evidence, const FitData& reduced) {
  const CurveClass curve_class = evidence.touch.curve_class;
  const auto placed = in_canonical_form(evidence.touch, evidence.nodes[evidence.mode].curve);
  if (!placed) {
    return std::nullopt;
  }
  const TouchedCurve& mode = *placed;
  const double scale = reduced.scale;
  const auto in_metres = [&](double t) {
    return normalised_shape(curve_class, {mode.shape.values, t}, 1.0 / scale);
  };
  KeptMode result;
  result.place.shape = {curve_class, in_metres(0.0).values};
  const Pose2& pose = mode.frame_T_curve;
  result.place.world_T_curve = reduced.frame * Pose2{scale * pose.x, scale * pose.y, pose.theta};
  result.as_arc = evidence.touch.as_arc;
  for (const double t : mode.t) {
    result.t.push_back(in_metres(t).t);
  }
  result.log_mass = log_mass(mode);
  result.log_all_modes = evidence.log_all_modes;
  result.fitted_chi2 = evidence.fitted_chi2;
  return result;
}

/// The mode as a fit to other points, of which each has the foot of the kept one that is `nearest`.
CanonicalFit as_fit(const KeptMode& mode, std::span<const std::size_t> nearest) {
  CanonicalFit fit;
  fit.shape = mode.place.shape;
  fit.world_T_curve = mode.place.world_T_curve;
  fit.points.resize(nearest.size());
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    fit.points[i].t = mode.t[nearest[i]];
  }
  return fit;
}

}  // namespace

KeptModes kept_modes(const Evidences& evidences, const FitData& reduced) {
  KeptModes result;
  if (residual_count(reduced) > reduced.points.size()) {
    return result;
  }
  for (const CurveClass curve_class : kCurveClasses) {
    const ClassEvidence* evidence = known_of(evidences, curve_class);
    if (evidence != nullptr && evidence->prior_mode_sought) {
      if (auto mode = kept(*evidence, reduced)) {
        result.modes.push_back(*std::move(mode));
      }
    }
  }
  for (std::size_t i = 0; !result.modes.empty() && i < reduced.points.size(); ++i) {
    result.points_m.push_back(world_m(reduced, reduced.points[i]));
  }
  return result;
}

std::vector<ClassEvidence> carried_modes(const KeptModes& kept, const ClassFits& fits,
                                         const FitData& reduced, double inflation,
                                         WorkBudget& work) {
  std::vector<ClassEvidence> carried;
  if (kept.modes.empty()) {
    return carried;
  }
  const std::vector<std::size_t> nearest = nearest_kept(kept.points_m, reduced);
  for (const KeptMode& mode : kept.modes) {
    const CurveClass i = mode.place.shape.curve_class;
    if (!fits[i]) {
      continue;
    }
    auto evidence = at_mode(as_fit(mode, nearest), mode.as_arc, fits[i]->chi2 / inflation,
                            points_of(*fits[i], reduced), inflation, work);
    const double before = mode.log_mass + 0.5 * mode.fitted_chi2;
    if (evidence && evidence->log_occam > before - kWorthAMode) {
      evidence->prior_mode_sought = true;
      evidence->log_all_modes = mode.log_all_modes;
      evidence->log_occam += mode.log_all_modes;
      carried.push_back(*std::move(evidence));
    }
  }
  return carried;
}

}  // namespace palpate
