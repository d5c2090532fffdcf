#include "core/recognition/weigh/tip_directions.h"

#include <algorithm>
#include <cmath>

#include "core/curves/curve.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/samples/tips/tip_sides.h"

namespace palpate {
namespace {

/// The curve's direction, with rising parameter, at the foot of a tip's centre (curve's frame);
/// zero if it has none. About a cusp the tip rolls: its way is across the line to its foot, if that
/// is longer than noise.
Vec2 direction_at_foot(const Curve& curve, const FootPoint& foot, const Vec2& centre_m,
                       double sigma_m) {
  // Of a right angle between the curve and the line to a foot, the cosine.
  constexpr double kNotAcross = 0.1;
  const CurveDerivatives at = derivatives(curve, foot.t);
  const Vec2 away = centre_m - at.position;
  const bool at_cusp = away.norm() > kNegligibleDeviations * sigma_m &&
                       std::abs(away.dot(at.first)) >= kNotAcross * away.norm() * at.first.norm();
  if (!at_cusp) {
    return at.first.isZero(0.0) ? Vec2(0.0, 0.0) : Vec2(at.first.normalized());
  }
  // What has a cusp for its foot lies outside of the bend.
  const bool is_left = cross(at.second, at.third) > 0.0;
  return (is_left ? -1.0 : 1.0) * left_of(away).normalized();
}

/// The curve's directions at the feet of the touches' points, in their frame; zero where it has
/// none, and where `work` is spent. Feet of the tips' centres, from which the curve is seen the
/// same however little of it bends: a surface point that is a little off may have its foot on the
/// other side of a sharp bend. A surface lies a radius away from a centre: an arm that was not
/// touched may be nearer.
std::vector<Vec2> directions_of(const Curve& curve, const CanonicalFit& fit, Feet feet,
                                const FitData& touches, WorkBudget& work) {
  std::vector<Vec2> directions;
  for (const FitPoint& point : touches.points) {
    if (!work.allows()) {
      directions.emplace_back(0.0, 0.0);
      continue;
    }
    work.spend(kind_of_foot(fit.shape.curve_class), 1);
    const Vec2 centre_m = fit.world_T_curve.to_local(world_m(touches, point));
    const double sigma_m = touches.scale / point.inverse_sigma;
    const double away_m = feet == Feet::Touched ? point.offset * touches.scale : 0.0;
    const FootPoint foot =
        foot_at_distance(curve, centre_m, away_m, kNegligibleDeviations * sigma_m);
    const Vec2 along = direction_at_foot(curve, foot, centre_m, sigma_m);
    directions.push_back(touches.frame.rotate_back(fit.world_T_curve.rotate(along)));
  }
  return directions;
}

/// Whether a patch was travelled as the curve's parameter rises (1) or falls (-1): as most of the
/// samples that `path` stands for have it. A patch runs along its curve one way, whatever the
/// direction that noise gave to one of its points. 0 where no point of `path` has a direction.
double sense_of(const std::vector<Vec2>& directions, const FitData& path, const PatchSpan& patch) {
  double sum = 0.0;
  for (std::size_t i = patch.begin; i < patch.end; ++i) {
    const FitPoint& point = path.points[i];
    sum += point.inverse_sigma * point.inverse_sigma * directions[i].dot(point.tangent);
  }
  return sum < 0.0 ? -1.0 : (sum > 0.0 ? 1.0 : 0.0);
}

/// The angle between two directions; pi where there was none. [rad]
double turned_by(const Vec2& before, const Vec2& after) {
  return before.isZero() ? kPi : std::abs(std::atan2(cross(before, after), before.dot(after)));
}

/// Whether a section shows its directions: a touch alone may have its one from elsewhere, samples
/// in a row have their neighbours.
bool is_told(const ReducedSection& section, const FitData& reduced) {
  return section.end - section.begin > 1 || !reduced.points[section.begin].tangent.isZero();
}

/// As set_directions().
double turn_to(const std::vector<Vec2>& directions, DirectionsOf which, const SmoothModel& smooth,
               FitData* touches) {
  double largest = 0.0;
  auto section = smooth.sections.begin();
  for (const PatchSpan& patch : touches->patches) {
    // As the smooth model saw it travelled: sides are told by that, and a sense that followed each
    // round's curve could turn about within some rounds.
    double sense = sense_of(directions, smooth.reduced, patch);
    if (sense == 0.0) sense = sense_of(directions, *touches, patch) < 0.0 ? -1.0 : 1.0;
    for (; section != smooth.sections.end() && section->begin < patch.end; ++section) {
      if ((which != DirectionsOf::AllPoints && !section->kept) ||
          (which == DirectionsOf::UntoldPoints && is_told(*section, smooth.reduced))) {
        continue;
      }
      for (std::size_t i = section->begin; i < section->end; ++i) {
        const Vec2 along = sense * directions[i];
        if (!along.isZero()) {
          largest = std::max(largest, turned_by(touches->points[i].tangent, along));
          touches->points[i].tangent = along;
        }
      }
    }
  }
  return largest;
}

/// What noise turns the line between the neighbours of each point of a stroke by: no error of its
/// direction is larger.
void take_errors_of_neighbours(FitData* touches) {
  for (const PatchSpan& patch : touches->patches) {
    for (std::size_t i = patch.begin; patch.size() > 1 && i < patch.end; ++i) {
      const FitPoint& before = touches->points[std::max(i, patch.begin + 1) - 1];
      const FitPoint& after = touches->points[std::min(i + 1, patch.end - 1)];
      const double turn = std::hypot(1.0 / before.inverse_sigma, 1.0 / after.inverse_sigma) /
                          (after.position - before.position).norm();
      touches->points[i].tangent_sigma = std::min(touches->points[i].tangent_sigma, turn);
    }
  }
}

/// Where an edge goes over into the arc: a radius that is as well may have the place of a sample on
/// the arc or beside it. An arc that turns by d leaves its tangent by r d^2 / 2, which noise hides.
void add_errors_of_fillet(const RoundedCorner& edges, FitData* touches) {
  const auto part = [&](std::size_t i) { return edges.distance(touches->points[i].position).part; };
  for (const PatchSpan& patch : touches->patches) {
    for (std::size_t i = patch.begin; i < patch.end; ++i) {
      const auto before = part(std::max(i, patch.begin + 1) - 1);
      const auto after = part(std::min(i + 1, patch.end - 1));
      if (before == after && before != RoundedCorner::Part::Arc) {
        continue;
      }
      FitPoint& point = touches->points[i];
      const double hidden = kNegligibleDeviations / point.inverse_sigma;
      const double turn = std::min(std::sqrt(2.0 * hidden / edges.radius), 2.0 * edges.half_turn);
      point.tangent_sigma = std::hypot(point.tangent_sigma, turn / kNegligibleDeviations);
    }
  }
}

}  // namespace

bool has_untold_tips(const SmoothModel& smooth) {
  return std::any_of(smooth.sections.begin(), smooth.sections.end(), [&](const auto& section) {
    return section.kept && smooth.reduced.points[section.begin].offset > 0.0 &&
           !is_told(section, smooth.reduced);
  });
}

bool has_kept_tips(const SmoothModel& smooth) {
  return std::any_of(smooth.sections.begin(), smooth.sections.end(), [&](const auto& section) {
    return section.kept && smooth.reduced.points[section.begin].offset > 0.0;
  });
}

bool is_swayed(const FitPoint& centre) {
  const double most = kNegligibleDeviations * centre.tangent_sigma;
  return 0.5 * most * most * centre.offset * centre.inverse_sigma > 1.0;
}

bool has_swayed_tips(const SmoothModel& smooth) {
  return std::any_of(smooth.reduced.points.begin(), smooth.reduced.points.end(), is_swayed);
}

bool has_uncertain_bends(const SmoothModel& smooth, std::span<const int> sides) {
  for (std::size_t p = 0; p < smooth.reduced.patches.size(); ++p) {
    const auto patch = smooth.reduced.patch(p);
    const bool told = patch.size() == 1 && !patch.front().tangent.isZero();
    if (!patch.empty() && patch.front().offset > 0.0 && !told && sides[p] == 0 &&
        !certain_turn(patch)) {
      return true;
    }
  }
  return false;
}

double set_directions(DirectionsOf which, const CanonicalFit& fit, Feet feet,
                      const SmoothModel& smooth, FitData* touches, WorkBudget& work) {
  const auto curve = make_curve(fit.shape.curve_class, fit.shape.values);
  return curve ? turn_to(directions_of(*curve, fit, feet, *touches, work), which, smooth, touches)
               : 0.0;
}

void tell_directions(const CanonicalFit& curve, const SmoothModel& smooth, FitData* touches,
                     WorkBudget& work) {
  set_directions(DirectionsOf::KeptPoints, curve, Feet::Touched, smooth, touches, work);
  take_errors_of_neighbours(touches);
}

std::vector<double> tell_directions(const RoundedCorner& edges, const SmoothModel& smooth,
                                    FitData* touches, WorkBudget& work) {
  work.spend(WorkKind::PlacedRow, touches->points.size());
  std::vector<Vec2> directions;
  for (const FitPoint& point : touches->points) {
    directions.push_back(edges.tangent(point.position));
  }
  turn_to(directions, DirectionsOf::KeptPoints, smooth, touches);
  take_errors_of_neighbours(touches);
  add_errors_of_fillet(edges, touches);
  std::vector<double> bends;  // about the arc, to the left
  for (const PatchSpan& patch : touches->patches) {
    bends.push_back(sense_of(directions, *touches, patch));
  }
  return bends;
}

std::vector<double> bends_of(const CanonicalFit& fit, const FitData& touches, WorkBudget& work) {
  std::vector<double> bends = turns_of(touches);
  const auto curve = make_curve(fit.shape.curve_class, fit.shape.values);
  if (!curve) {
    return bends;
  }
  const std::vector<Vec2> directions = directions_of(*curve, fit, Feet::Nearest, touches, work);
  for (std::size_t p = 0; p < bends.size(); ++p) {
    if (certain_turn(touches.patch(p))) {
      continue;
    }
    double sum = 0.0;
    for (std::size_t i = touches.patches[p].begin; i < touches.patches[p].end; ++i) {
      sum += geometry(*curve, fit.points[i].t).kappa;
    }
    bends[p] = sense_of(directions, touches, touches.patches[p]) < 0.0 ? -sum : sum;
  }
  return bends;
}

std::vector<double> senses_of(const CanonicalFit& fit, const FitData& touches, WorkBudget& work) {
  std::vector<double> senses(touches.patches.size(), 0.0);
  if (const auto curve = make_curve(fit.shape.curve_class, fit.shape.values)) {
    const std::vector<Vec2> directions = directions_of(*curve, fit, Feet::Nearest, touches, work);
    for (std::size_t p = 0; p < senses.size(); ++p) {
      senses[p] = sense_of(directions, touches, touches.patches[p]);
    }
  }
  return senses;
}

}  // namespace palpate
