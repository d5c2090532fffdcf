#include "core/recognition/posterior/kept_modes.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/recognition/posterior/mode_search.h"

namespace palpate {
namespace {

/// For each point of `reduced`, the kept one that lies nearest.
std::vector<std::size_t> nearest_kept(const KeptModes& kept, const FitData& reduced) {
  std::vector<Vec2> there;
  there.reserve(kept.points.size());
  for (const Vec2& point : kept.points) {
    const Vec2 scaled = kept.scale * point;
    there.push_back(reduced.frame.to_local(kept.frame * scaled) / reduced.scale);
  }
  std::vector<std::size_t> nearest;
  nearest.reserve(reduced.points.size());
  for (const FitPoint& point : reduced.points) {
    const auto closer = [&](const Vec2& a, const Vec2& b) {
      return (a - point.position).squaredNorm() < (b - point.position).squaredNorm();
    };
    nearest.push_back(static_cast<std::size_t>(
        std::min_element(there.begin(), there.end(), closer) - there.begin()));
  }
  return nearest;
}

/// The mode as a fit to `reduced`, with the feet of the nearest points.
CanonicalFit as_fit(const KeptMode& mode, const KeptModes& kept, const FitData& reduced,
                    std::span<const std::size_t> nearest) {
  const CurveClass curve_class = mode.chart.curve_class;
  const auto in_metres = [&](double t) {
    return normalised_shape(curve_class, {mode.shape.values, t}, 1.0 / kept.scale);
  };
  CanonicalFit fit;
  fit.shape = {curve_class, in_metres(0.0).values};
  const Pose2& pose = mode.frame_T_curve;
  fit.world_T_curve = kept.frame * Pose2{kept.scale * pose.x, kept.scale * pose.y, pose.theta};
  fit.points.resize(reduced.points.size());
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    fit.points[i].t = in_metres(mode.t[nearest[i]]).t;
  }
  return fit;
}

}  // namespace

KeptModes kept_modes(const Evidences& evidences, const FitData& reduced) {
  KeptModes kept;
  kept.frame = reduced.frame;
  kept.scale = reduced.scale;
  if (residual_count(reduced) > reduced.points.size()) {
    return kept;
  }
  for (const CurveClass curve_class : kCurveClasses) {
    const ClassEvidence* evidence = known_of(evidences, curve_class);
    if (evidence == nullptr || !evidence->prior_mode_sought) {
      continue;
    }
    const TouchedCurve& mode = evidence->nodes[evidence->mode].curve;
    kept.modes.push_back({evidence->touch.chart(), mode.shape, mode.frame_T_curve, mode.t,
                          log_mass(mode), evidence->log_all_modes, evidence->fitted_chi2});
  }
  if (!kept.modes.empty()) {
    for (const FitPoint& point : reduced.points) {
      kept.points.push_back(point.position);
    }
  }
  return kept;
}

std::vector<ClassEvidence> carried_modes(const KeptModes& kept, const ClassFits& fits,
                                         const FitData& reduced, double inflation,
                                         WorkBudget& work) {
  // log: as much as a search must be able to gain to be made (prior_modes.cpp, kWorthAMode).
  constexpr double kLost = 2.0;
  std::vector<ClassEvidence> carried;
  if (kept.modes.empty()) {
    return carried;
  }
  const std::vector<std::size_t> nearest = nearest_kept(kept, reduced);
  for (const KeptMode& mode : kept.modes) {
    const auto i = static_cast<std::size_t>(mode.chart.curve_class);
    if (!fits[i]) {
      continue;
    }
    auto evidence = at_mode(as_fit(mode, kept, reduced, nearest), mode.chart.as_arc,
                            fits[i]->chi2 / inflation, reduced, inflation, work);
    const double before = mode.log_mass + 0.5 * mode.fitted_chi2;
    if (evidence && evidence->log_occam > before - kLost) {
      evidence->prior_mode_sought = true;
      evidence->log_all_modes = mode.log_all_modes;
      evidence->log_occam += mode.log_all_modes;
      carried.push_back(*std::move(evidence));
    }
  }
  return carried;
}

}  // namespace palpate
