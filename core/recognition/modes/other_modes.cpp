#include "core/recognition/modes/other_modes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "core/recognition/modes/mode_search.h"
#include "core/recognition/modes/prior_starts.h"
#include "core/recognition/modes/touched_arc.h"

namespace palpate {
namespace {

constexpr double kNoMass = -std::numeric_limits<double>::infinity();

/// The best mode of every arm, by arm_of().
struct ArmMass {
  std::size_t arm = 0;
  double log_mass = 0.0;
};

void keep_best(ArmMass mass, std::vector<ArmMass>* of_arms) {
  const auto same = std::find_if(of_arms->begin(), of_arms->end(),
                                 [&](const ArmMass& other) { return other.arm == mass.arm; });
  if (same == of_arms->end()) {
    of_arms->push_back(mass);
  } else {
    same->log_mass = std::max(same->log_mass, mass.log_mass);
  }
}

/// The evidence of the modes that the prior leads to along `path`, at the best one, where they have
/// more than `least`, and of the mode that it has, if any.
void take_prior_modes(const ClassEvidence& path, const FitData& data, double least,
                      ClassEvidence* evidence, WorkBudget& work) {
  // log over `least`, e^-9 of the best class: what is left of a fiftieth. A class of less, which
  // the most probable start led to, is not worth the time of others.
  constexpr double kWorthMore = 5.0;
  Touch touch = along_patch(path.touch, data);
  touch.curve_class = evidence->touch.curve_class;
  touch.as_arc = false;
  // Either sign of a cubical parabola's b has arms that bend alike: the most probable start tells
  // little of the next.
  const bool told_by_first = touch.curve_class != CurveClass::CubicalParabola;
  bool further = false;
  const double half_chi2 = 0.5 * evidence->fitted_chi2;
  std::vector<ArmMass> of_arms;
  double best = kNoMass;
  if (!evidence->nodes.empty()) {
    best = log_mass(evidence->nodes[evidence->mode].curve);
    const TouchedCurve& mode = evidence->nodes[evidence->mode].curve;
    of_arms.push_back({arm_of(touch, evidence->touch, mode), best});
    if (const double others = std::expm1(evidence->log_all_modes); others > 0.0) {
      Touch other = evidence->touch;  // add_arc
      other.as_arc = !other.as_arc;
      of_arms.push_back({arm_of(touch, other, mode), best + std::log(others)});
    }
  }
  const auto along = in_canonical_form(path.touch, path.nodes[path.mode].curve);
  if (!along) {
    return;
  }
  for (const PriorStart& start : prior_starts(touch, path.touch.curve_class, *along)) {
    if ((further && told_by_first && !(evidence->log_occam > least + kWorthMore)) ||
        !work.allows()) {
      break;
    }
    auto mode = followed_from_prior(start.touch, data, start.curve,
                                    std::max(best - kToldMass, least - half_chi2), work);
    further = further || mode || !start.touch.as_arc;  // an arc may end at a cubical parabola
    if (!mode) {
      continue;
    }
    const double mass = log_mass(*mode);
    keep_best({arm_of(touch, start.touch, *mode), mass}, &of_arms);
    if (mass > best) {
      best = mass;
      evidence->touch = start.touch;
      set_mode(*std::move(mode), evidence);
    }
  }
  double sum = 0.0;
  for (const ArmMass& arm : of_arms) {
    sum += std::exp(arm.log_mass - best);
  }
  if (sum > 0.0) {
    set_log_all_modes(std::log(sum), evidence);
  }
}

}  // namespace

ClassEvidence with_prior_mode(ClassEvidence evidence, const ClassEvidence& path,
                              const FitData& data, double least, WorkBudget& work) {
  evidence.prior_mode_sought = true;
  take_prior_modes(path, data, least, &evidence, work);
  return evidence;
}

std::optional<ClassEvidence> from_prior(CurveClass curve_class, double fitted_chi2,
                                        const ClassEvidence& path, const FitData& data,
                                        double least, WorkBudget& work) {
  ClassEvidence evidence;
  evidence.touch = along_patch(path.touch, data);
  evidence.touch.curve_class = curve_class;
  evidence.fitted_chi2 = fitted_chi2;
  evidence.prior_mode_sought = true;
  take_prior_modes(path, data, least, &evidence, work);
  return !evidence.nodes.empty() && is_of_optimum(evidence) ? std::optional(std::move(evidence))
                                                            : std::nullopt;
}

ClassEvidence with_mode_at_cusp(ClassEvidence spline, const ClassEvidence& semi_cubical,
                                const FitData& data, WorkBudget& work) {
  const TouchedCurve& from = semi_cubical.nodes[semi_cubical.mode].curve;
  Touch touch = semi_cubical.touch;
  touch.curve_class = spline.touch.curve_class;
  constexpr double kLeastC = 1e-9;  // a curve of c = 0 is no spline; far below any noise
  TouchedVector z = from.z;
  z.tail<2>() = from.z.segment<2>(3);  // offset and turn come after c
  z[3] = kLeastC;
  work.spend(WorkKind::PosteriorRow, rows_of_curve(data));
  auto mode = curve_at(touch, z, from, data);
  if (!mode) {
    return spline;
  }
  mode = descend(touch, data, *std::move(mode), -1, work, kStepsFromFit);
  const double before = log_mass(spline.nodes[spline.mode].curve) + spline.log_all_modes;
  const double gain = log_mass(*mode) - before;
  if (gain > 0.0) {
    spline.touch = touch;
    set_mode(*std::move(mode), &spline);
    set_log_all_modes(std::log1p(std::exp(-gain)), &spline);
  }
  return spline;
}

ClassEvidence with_mode_at_parabola(ClassEvidence spline, const ClassEvidence& parabola,
                                    const FitData& data, WorkBudget& work) {
  const TouchedCurve& from = parabola.nodes[parabola.mode].curve;
  std::optional<TouchedArc> best;
  double mass = kNoMass;
  for (const bool with : {true, false}) {
    auto arc = arc_of_parabola(parabola.touch, from, with);
    work.spend(WorkKind::PosteriorRow, rows_of_curve(data));
    auto curve = arc ? curve_at(arc->touch, arc->curve.z, arc->curve, data) : std::nullopt;
    if (!curve) {
      continue;
    }
    curve = descend(arc->touch, data, *std::move(curve), -1, work, kStepsFromFit);
    if (log_mass(*curve) > mass) {
      mass = log_mass(*curve);
      arc->curve = *std::move(curve);
      best = std::move(arc);
    }
    if (best && best->curve.left_to_gain > 0.0) {
      break;  // settled: the other way round it lies beyond the parabola
    }
  }
  if (!best) {
    return spline;
  }
  // What it has besides its mode may be an arc's already, and of arcs the best one counts (arm_of).
  const double before = log_mass(spline.nodes[spline.mode].curve);
  const double others = std::expm1(spline.log_all_modes);
  if (mass > before) {
    const double of_no_arc = spline.touch.as_arc ? others : 1.0;
    spline.touch = best->touch;
    set_mode(std::move(best->curve), &spline);
    set_log_all_modes(std::log1p(of_no_arc * std::exp(before - mass)), &spline);
  } else if (!spline.touch.as_arc) {
    set_log_all_modes(std::log1p(std::max(others, std::exp(mass - before))), &spline);
  }
  return spline;
}

}  // namespace palpate
