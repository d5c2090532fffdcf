#include "core/recognition/weigh/own_directions.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/fit/orthogonal/touchable.h"
#include "core/recognition/weigh/tip_directions.h"

namespace palpate {
namespace {

/// As the classes are fitted to surface points: what is plausible is settled later.
constexpr RefineEffort kNearEnough{100, 1, 1e-3};

/// What all classes are moved by.
struct Tips {
  const FitData& reduced;  ///< surface points along the directions of one curve
  const FitData& centres;  ///< of the same tips
  const SmoothModel& smooth;
  std::span<const int> sides;
  WorkBudget& work;
};

/// The unit normal at the foot of a centre: left of increasing t, or where the polynomial grows.
Vec2 normal_at(const ClassFit& fit, const FitData& centres, std::size_t i) {
  return fit.polynomial
             ? place_on(*fit.polynomial, fit.polynomial->t[i], centres.points[i]).normal
             : Vec2(conic_gradient(fit.implicit->coefficients, fit.implicit->feet[i]).normalized());
}

/// By how much the tips of a patch lie on the positive side of a curve, as their sides have them.
double lie_left(const ClassFit& fit, const Tips& tips, std::size_t p) {
  double sum = 0.0;
  for (std::size_t i = tips.reduced.patches[p].begin; i < tips.reduced.patches[p].end; ++i) {
    sum += tips.sides[p] * tips.centres.points[i].offset *
           left_of(tips.reduced.points[i].tangent).dot(normal_at(fit, tips.centres, i));
  }
  return sum;
}

/// On which side of the curve most tips lie, as their patches have them.
int side_of(const ClassFit& fit, const Tips& tips) {
  double sum = 0.0;
  for (std::size_t p = 0; p < tips.reduced.patches.size(); ++p) {
    sum += lie_left(fit, tips, p);
  }
  return sum < 0.0 ? -1 : 1;
}

/// Whether the tips still lie there, and every stroke's do: what has a stroke otherwise is another
/// way's. Of single touches most do: their sides are told along a curve of their centres, and one
/// that is no curve of the part may wind.
bool lie_on(int side, const ClassFit& fit, const Tips& tips) {
  for (std::size_t p = 0; p < tips.reduced.patches.size(); ++p) {
    if (tips.reduced.patches[p].size() > 1 && side * lie_left(fit, tips, p) < 0.0) {
      return false;
    }
  }
  return side_of(fit, tips) == side;
}

/// The surface points as a curve beside the centres has them; those that show their directions
/// stay.
FitData surface_along(const ClassFit& beside, int side, const Tips& tips) {
  FitData surface = tips.reduced;
  auto section = tips.smooth.sections.begin();
  for (std::size_t p = 0; p < surface.patches.size(); ++p) {
    for (; section != tips.smooth.sections.end() && section->begin < surface.patches[p].end;
         ++section) {
      for (std::size_t i = section->begin; i < section->end; ++i) {
        const FitPoint& centre = tips.centres.points[i];
        if (!(centre.offset > 0.0) || !(section->kept || is_swayed(centre))) {
          continue;
        }
        if (const Vec2 normal = normal_at(beside, tips.centres, i); normal.allFinite()) {
          surface.points[i].position = centre.position - side * centre.offset * normal;
          surface.points[i].tangent = -(side * tips.sides[p]) * left_of(normal);
        }
      }
    }
  }
  return surface;
}

/// The class from that start, beside the centres, as its own surface points have it; nullopt if it
/// is no curve there.
std::optional<ClassFit> moved(ClassFit start, const Tips& tips) {
  const int side = side_of(start, tips);
  ClassFit fit = beside_centres(std::move(start), side, tips.centres, kNearEnough, tips.work);
  if (!std::isfinite(fit.chi2) || !lie_on(side, fit, tips) ||
      (fit.implicit && !is_touchable(*fit.implicit, tips.centres))) {
    return std::nullopt;
  }
  auto surface = std::make_shared<const FitData>(surface_along(fit, side, tips));
  if (fit.polynomial) {
    fit.polynomial->side = 0;
    fit.polynomial = placed_on(surface->points, *std::move(fit.polynomial));
    fit.chi2 = fit.polynomial->chi2;
  } else {
    fit.implicit->side = 0;
    fit.implicit = placed_on(surface->points, *std::move(fit.implicit));
    fit.chi2 = fit.implicit->chi2;
  }
  fit.own_points = std::move(surface);
  return fit;
}

/// The better of two fits of a class, where there are any.
void keep_better(std::optional<ClassFit> fit, std::optional<ClassFit>* best) {
  if (fit && (!*best || fit->chi2 < (*best)->chi2)) {
    *best = std::move(fit);
  }
}

/// The class as it is beside the centres, from each of its fits; nullopt if it is nowhere.
std::optional<ClassFit> moved_class(CurveClass i, const ClassFits& fits, const OtherStarts& others,
                                    const Tips& tips) {
  std::optional<ClassFit> best;
  for (const ClassFits* starts : {&fits, others.of_centres, others.before}) {
    if (starts != nullptr && (*starts)[i] && !(*starts)[i]->at_limit && tips.work.allows()) {
      keep_better(moved(*(*starts)[i], tips), &best);
    }
  }
  return best;
}

/// The conic beside the centres, from where it was and from its limits, as they have moved.
std::optional<ClassFit> moved_conic(const ClassFits& fits, const OtherStarts& others,
                                    const Tips& tips) {
  std::optional<ClassFit> best;
  for (const CurveClass i : {CurveClass::Ellipse, CurveClass::Hyperbola}) {
    keep_better(moved_class(i, fits, others, tips), &best);
  }
  const auto from_limit = [&](const ConicCoefficients& coefficients) {
    if (tips.work.allows()) {
      ClassFit start;
      start.implicit = placed_on(tips.centres.points, ImplicitFit{coefficients, 0.0, 0, {}});
      keep_better(moved(std::move(start), tips), &best);
    }
  };
  if (const auto& parabola = fits[CurveClass::Parabola]; parabola && parabola->polynomial) {
    from_limit(conic_of_parabola(*parabola->polynomial));
  }
  if (const auto& circle = fits[CurveClass::Circle]; circle && circle->implicit) {
    from_limit(circle->implicit->coefficients);
  }
  if (best) {
    best->curve_class = discriminant(best->implicit->coefficients) > 0.0 ? CurveClass::Ellipse
                                                                         : CurveClass::Hyperbola;
  }
  return best;
}

/// The parabola as the limit of a class.
std::optional<ClassFit> limit_for(CurveClass i, const ClassFits& fits) {
  auto limit = fits[CurveClass::Parabola];
  if (limit) {
    limit->curve_class = i;
    limit->at_limit = true;
  }
  return limit;
}

}  // namespace

bool has_lone_tips(const FitData& reduced, const SmoothModel& smooth) {
  return std::any_of(reduced.patches.begin(), reduced.patches.end(), [&](const PatchSpan& patch) {
    return patch.size() == 1 && smooth.reduced.points[patch.begin].offset > 0.0;
  });
}

ClassFits along_own_directions(ClassFits fits, const FitData& reduced, std::span<const int> sides,
                               const SmoothModel& smooth, const OtherStarts& others,
                               WorkBudget& work) {
  const Tips tips{reduced, smooth.reduced, smooth, sides, work};
  for (const CurveClass i :
       {CurveClass::Line, CurveClass::Circle, CurveClass::Parabola, CurveClass::CubicalParabola,
        CurveClass::SemiCubicalParabola, CurveClass::CubicSpline}) {
    auto fit = fits[i] ? moved_class(i, fits, others, tips) : std::nullopt;
    if (fit && fit->chi2 < fits[i]->chi2) {
      if (fits[i]->rival) {
        fit->rival = placed_on(fit->own_points->points, *fits[i]->rival);
      }
      fits[i] = std::move(fit);
    }
  }
  auto conic = moved_conic(fits, others, tips);
  for (const CurveClass i : {CurveClass::Ellipse, CurveClass::Hyperbola}) {
    if (fits[i] && !fits[i]->at_limit && conic && !(conic->chi2 < fits[i]->chi2)) {
      conic.reset();
    }
  }
  for (const CurveClass i : {CurveClass::Ellipse, CurveClass::Hyperbola}) {
    if (!fits[i]) {
      continue;
    }
    if (conic && conic->curve_class == i) {
      fits[i] = conic;
    } else if (conic || fits[i]->at_limit) {
      fits[i] = limit_for(i, fits);
    }
  }
  return fits;
}

}  // namespace palpate
