#include "core/recognition/samples/tips/tip_sides.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/samples/tips/strokes_together.h"

namespace palpate {

int stated_side(MaterialSide side) {
  switch (side) {
    case MaterialSide::Left:
      return -1;
    case MaterialSide::Right:
      return 1;
    case MaterialSide::Unspecified:
      break;
  }
  return 0;
}

namespace {

double turn_of(std::span<const FitPoint> patch) {
  double turn = 0.0;
  for (std::size_t i = 1; i < patch.size(); ++i) {
    turn += turn_between(patch[i - 1].tangent, patch[i].tangent);
  }
  return turn;
}

/// log odds of left of travel over right as the side to which a patch's measured normals point; the
/// tip centres lie there. 0 without normals.
double log_odds_of_left(const StoredPatch& patch, const FitData& reduced,
                        std::span<const FitPoint> path) {
  // Standard deviation of the direction of travel, one error for the whole patch. Reduced points
  // know theirs to a few hundredths; touches take it from a curve that may not be the right one
  // yet. With 0.3 a normal within 51 degrees of the path's normal decides; one farther off decides
  // nothing. [rad]
  constexpr double kTravelSigma = 0.3;
  // Smaller standard deviations add nothing to the error of travel. [rad]
  constexpr double kLeastSigma = 1e-3;
  if (patch.details.empty() || path.empty()) {
    return 0.0;
  }
  const ToLocal to_frame(reduced.frame);
  double information = 0.0;
  double to_the_left = 0.0;
  for (std::size_t i = 0; i < patch.samples.size(); ++i) {
    const SampleDetail& detail = patch.details[i];
    if (!(detail.normal_sigma_rad > 0.0)) {
      continue;
    }
    const Vec2 place = to_frame(patch.samples[i].position_m) / reduced.scale;
    const auto nearest =
        std::min_element(path.begin(), path.end(), [&](const FitPoint& a, const FitPoint& b) {
          return (a.position - place).squaredNorm() < (b.position - place).squaredNorm();
        });
    const double sigma = std::max(detail.normal_sigma_rad, kLeastSigma);
    const double weight = 1.0 / (sigma * sigma);
    information += weight;
    to_the_left += weight * left_of(nearest->tangent).dot(reduced.frame.rotate_back(detail.normal));
  }
  if (!(information > 0.0)) {
    return 0.0;
  }
  // By von Mises' law of this concentration about either side.
  const double concentration = 1.0 / (1.0 / information + kTravelSigma * kTravelSigma);
  return 2.0 * concentration * to_the_left / information;
}

/// That side, beyond doubt; 0 if the normals leave one.
int measured_side(const StoredPatch& patch, const FitData& reduced,
                  std::span<const FitPoint> path) {
  const double log_odds = log_odds_of_left(patch, reduced, path);
  return std::abs(log_odds) < kNegligibleLogOdds ? 0 : (log_odds > 0.0 ? 1 : -1);
}

/// For each patch what is said of the surest of those that it runs along with, in its own travel.
/// `said`: one per patch; the sign is a side of its travel (0 counts as positive), the size says
/// how sure that is.
std::vector<double> said_together(std::span<const Alongside> strokes,
                                  std::span<const double> said) {
  std::vector<double> surest(said.size(), 0.0);  // by the first of each, in its travel
  for (std::size_t p = 0; p < said.size(); ++p) {
    const double by_this = said[p] != 0.0 ? said[p] : std::numeric_limits<double>::min();
    double& of_all = surest[strokes[p].first];
    if (std::abs(by_this) > std::abs(of_all)) {
      of_all = strokes[p].sense * by_this;
    }
  }
  std::vector<double> together(said.size());
  for (std::size_t p = 0; p < said.size(); ++p) {
    together[p] = strokes[p].sense * surest[strokes[p].first];
  }
  return together;
}

/// The known sides, with those of patches that run along one whose side is known. Where some are
/// known that contradict one another, the rest stay open.
std::vector<int> known_together(std::span<const Alongside> strokes, std::span<const int> known) {
  std::vector<int> left(known.size(), 0);  // by the first of each: known in its travel
  std::vector<int> right(known.size(), 0);
  for (std::size_t p = 0; p < known.size(); ++p) {
    left[strokes[p].first] += strokes[p].sense * known[p] > 0 ? 1 : 0;
    right[strokes[p].first] += strokes[p].sense * known[p] < 0 ? 1 : 0;
  }
  std::vector<int> together(known.begin(), known.end());
  for (std::size_t p = 0; p < known.size(); ++p) {
    const std::size_t first = strokes[p].first;
    if (known[p] == 0 && (left[first] == 0 || right[first] == 0)) {
      together[p] = strokes[p].sense * (std::min(left[first], 1) - std::min(right[first], 1));
    }
  }
  return together;
}

}  // namespace

std::optional<double> certain_turn(std::span<const FitPoint> patch) {
  double weight = 0.0;
  double length = 0.0;
  for (std::size_t i = 0; i < patch.size(); ++i) {
    weight += patch[i].inverse_sigma * patch[i].inverse_sigma;
    length += i > 0 ? (patch[i].position - patch[i - 1].position).norm() : 0.0;
  }
  const double turn = turn_of(patch);
  // Standard deviation for a parabola fitted to evenly spread samples: sigma sqrt(720 / n) /
  // length.
  return weight > 0.0 && std::abs(turn) * length > kNegligibleDeviations * std::sqrt(720.0 / weight)
             ? std::optional(turn)
             : std::nullopt;
}

std::vector<double> turns_of(const FitData& reduced) {
  std::vector<double> turns;
  for (std::size_t p = 0; p < reduced.patches.size(); ++p) {
    turns.push_back(turn_of(reduced.patch(p)));
  }
  return turns;
}

std::vector<int> known_sides(std::span<const StoredPatch> patches, const FitData& reduced) {
  std::vector<int> known(reduced.patches.size(), 0);
  std::size_t p = 0;
  for (const StoredPatch& patch : patches) {
    if (patch.samples.empty()) {
      continue;
    }
    if (patch.context.tip_radius_m > 0.0) {
      const bool lone = patch.samples.size() == 1;
      const int measured = measured_side(patch, reduced, reduced.patch(p));
      known[p] = measured != 0 ? measured : lone ? 0 : stated_side(patch.context.material_side);
    }
    ++p;
  }
  return known;
}

bool are_open(std::span<const StoredPatch> patches, const FitData& data, const FitData& reduced) {
  const double tip = data.points.front().offset;
  const std::vector<int> known = known_sides(patches, reduced);
  return tip > 0.0 &&
         std::ranges::all_of(data.points, [&](const auto& p) { return p.offset == tip; }) &&
         std::ranges::all_of(known, [](int side) { return side == 0; });
}

PossibleSides possible_sides(std::span<const StoredPatch> patches, const FitData& reduced,
                             std::span<const double> bends, std::span<const double> senses,
                             WorkBudget& work) {
  std::vector<int> known = known_sides(patches, reduced);
  const auto has_tip = [&](std::size_t p) {
    const auto points = reduced.patch(p);
    return !points.empty() && points.front().offset > 0.0;
  };
  const auto any_unknown = [&] {
    bool any = false;
    for (std::size_t i = 0; i < known.size(); ++i) {
      any = any || (has_tip(i) && known[i] == 0);
    }
    return any;
  };
  if (!any_unknown()) {
    return {{known}, 0};
  }
  const std::vector<Alongside> strokes = strokes_together(patches, reduced, work);
  known = known_together(strokes, known);
  if (!any_unknown()) {
    return {{known}, 0};
  }
  const std::vector<double> bend = said_together(strokes, bends);
  const std::vector<double> sense =
      said_together(strokes, senses.empty() ? std::vector<double>(known.size(), 1.0)
                                            : std::vector<double>(senses.begin(), senses.end()));
  PossibleSides sides;
  std::vector<bool> counted(known.size(), false);
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (has_tip(i) && known[i] == 0 && !counted[strokes[i].first]) {
      counted[strokes[i].first] = true;
      ++sides.open;
    }
  }
  const auto add = [&](auto side_of) {
    std::vector<int> way(known.size());
    for (std::size_t i = 0; i < known.size(); ++i) {
      way[i] = known[i] != 0 || !has_tip(i) ? known[i] : side_of(i);
    }
    if (std::find(sides.ways.begin(), sides.ways.end(), way) == sides.ways.end()) {
      sides.ways.push_back(std::move(way));
    }
  };
  // If the path bends left, the tips lie outside, on the right, if the part is convex there.
  const auto outside_of_bend = [&](std::size_t i) { return bend[i] >= 0.0 ? -1 : 1; };
  const auto left_of_curve = [&](std::size_t i) { return sense[i] < 0.0 ? -1 : 1; };
  add([&](std::size_t i) { return outside_of_bend(i); });
  add([&](std::size_t i) { return -outside_of_bend(i); });
  add([&](std::size_t i) { return left_of_curve(i); });
  add([&](std::size_t i) { return -left_of_curve(i); });
  return sides;
}

double log_likelihood_of_normals(std::span<const StoredPatch> patches, const FitData& reduced,
                                 std::span<const int> sides) {
  double sum = 0.0;
  std::size_t p = 0;
  for (const StoredPatch& patch : patches) {
    if (!patch.samples.empty()) {
      sum += 0.5 * sides[p] * log_odds_of_left(patch, reduced, reduced.patch(p));
      ++p;
    }
  }
  return sum;
}

double tip_removal_error(const FitPoint& point, double noise) {
  return point.offset > 0.0
             ? point.offset * std::min(1.0, kNegligibleDeviations * noise * point.tangent_sigma)
             : 0.0;
}

FitData on_surface(const FitData& reduced, std::span<const int> sides) {
  FitData surface = reduced;
  for (std::size_t p = 0; p < surface.patches.size(); ++p) {
    for (std::size_t i = surface.patches[p].begin; i < surface.patches[p].end; ++i) {
      FitPoint& point = surface.points[i];
      point.position -= sides[p] * point.offset * left_of(point.tangent);
      point.offset = 0.0;
    }
  }
  return surface;
}

}  // namespace palpate
