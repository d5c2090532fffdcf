#include "core/recognition/modes/prior_starts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "core/curves/curve.h"
#include "core/recognition/modes/touched_arc.h"
#include "core/recognition/prior/arc_coordinates.h"
#include "core/recognition/prior/prior_lattice.h"
#include "core/recognition/prior/size_law.h"

namespace palpate {
namespace {

/// One more finds little that these do not (tests/bench/accuracy/bench_prior.cpp), and each costs a
/// search.
constexpr std::size_t kMostStarts = 4;

/// A shape of the prior with one of the senses and sides that it stands for.
struct Sided {
  TouchedVector z = TouchedVector::Zero();
  double curvature = 0.0;
  double rate = 0.0;     ///< relative_rate of the prior's shape
  double leading = 1.0;  ///< sign of a cubical parabola's a
  double travel = 1.0;   ///< with or against the touch's tangent
};

Sided mirrored(CurveClass curve_class, Sided shape) {
  const int place = place_coordinate(curve_class);
  switch (curve_class) {
    case CurveClass::Circle:
      break;
    case CurveClass::Ellipse:  // the direction of the tangent
      shape.z[place] = kPi - shape.z[place];
      shape.rate = -shape.rate;
      break;
    case CurveClass::CubicalParabola:
      shape.leading = -1.0;
      shape.z[1] = -shape.z[1];
      shape.curvature = -shape.curvature;
      shape.rate = -shape.rate;
      break;
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      shape.z[1] = -shape.z[1];
      [[fallthrough]];
    default:  // the image is the same curve, passed the other way
      shape.z[place] = -shape.z[place];
      shape.rate = -shape.rate;
      break;
  }
  return shape;
}

/// Travelled so that it bends to the side that the path does.
Sided bent_like(double curvature, Sided shape) {
  if (shape.curvature * curvature < 0.0) {
    shape.curvature = -shape.curvature;
    shape.travel = -1.0;
  }
  return shape;
}

/// The arc that the path is to third order, by nearly its length, travelled so that it bends to the
/// left. The second derivative along it is the least with which x, across the third derivative,
/// bends as a spline's does, and by a quarter of what is expected.
Sided arc_like(double curvature, double rate) {
  const double bend = 0.25 * law_of_arc(0).scale;
  const double seen = std::abs(curvature);
  const double third = std::hypot(seen * seen, rate);
  // x'' = (alpha gamma + kappa^3) / |third|.
  const double lacking = bend * third - seen * seen * seen;
  Sided shape;
  shape.z.head<4>() << (lacking > 0.0 && rate != 0.0 ? lacking / rate : 0.0), seen, -seen * seen,
      rate;
  shape.travel = std::copysign(1.0, curvature);
  return shape;
}

/// Which arm, side and sense of travel, and on which side of the inflection's normal a cubical
/// parabola's axis lies: between them no way leads downhill, or a long one.
std::size_t sector_of(CurveClass curve_class, const Sided& shape) {
  constexpr int kBend = 3;  // the spline's c
  const int place = place_coordinate(curve_class);
  const bool leans = curve_class == CurveClass::CubicalParabola && shape.z[1] > 0.0;
  return (place >= 0 && shape.z[place] > 0.0 ? 1U : 0U) + (shape.z[kBend] > 0.0 ? 2U : 0U) +
         (shape.travel > 0.0 ? 4U : 0U) + (shape.leading > 0.0 ? 8U : 0U) + (leans ? 16U : 0U);
}
constexpr std::size_t kSectors = 32;

double speed_at(const Curve& curve, double t) { return derivatives(curve, t).first.norm(); }

/// Arc length from t0 to t, by Simpson's rule: feet need only come near, from where they are
/// followed. Bounded, where an adaptive rule takes long at cusps and for arcs without an end.
double rough_arc_length(const Curve& curve, double t0, double t) {
  constexpr int kParts = 4;
  const double h = (t - t0) / (2 * kParts);
  double sum = speed_at(curve, t0) + speed_at(curve, t);
  for (int i = 1; i < 2 * kParts; ++i) {
    sum += (i % 2 == 1 ? 4.0 : 2.0) * speed_at(curve, t0 + i * h);
  }
  return h / 3.0 * sum;
}

/// The parameter that lies `s` on from t, by one step of Runge and Kutta's rule.
double rough_parameter(const Curve& curve, double t, double s) {
  const double k1 = s / speed_at(curve, t);
  const double k2 = s / speed_at(curve, t + 0.5 * k1);
  const double k3 = s / speed_at(curve, t + 0.5 * k2);
  const double k4 = s / speed_at(curve, t + k3);
  return t + (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0;
}

/// A foot by its number, and how far along the path it lies.
struct AlongPath {
  std::size_t foot = 0;
  double s = 0.0;
};

/// The curve itself, with the feet as far along it as those of the path are: `feet`, by how far.
std::optional<PriorStart> start_at(const Touch& touch, const Sided& shape,
                                   const std::vector<AlongPath>& feet) {
  PriorStart start;
  start.touch = touch;
  start.touch.tangent *= shape.travel;
  if (touch.curve_class == CurveClass::CubicalParabola) {
    start.touch.shape.values[0] = shape.leading;
  }
  const auto at = shape_at(touch.chart(), shape.z, start.touch.shape);
  const auto curve = at ? make_curve(touch.curve_class, at->values) : std::nullopt;
  if (!curve) {
    return std::nullopt;
  }
  start.curve.z = shape.z;
  start.curve.shape = *at;
  start.curve.t.resize(feet.size());
  bool finite = true;
  double t = at->t;
  double s = 0.0;
  const auto go_to = [&](const AlongPath& foot) {  // outwards, from foot to foot
    t = rough_parameter(*curve, t, shape.travel * (foot.s - s));
    s = foot.s;
    start.curve.t[foot.foot] = t;
    finite = finite && std::isfinite(t);
  };
  const auto ahead =
      std::find_if(feet.begin(), feet.end(), [](const AlongPath& f) { return f.s >= 0.0; });
  std::for_each(ahead, feet.end(), go_to);
  t = at->t;
  s = 0.0;
  std::for_each(std::make_reverse_iterator(ahead), feet.rend(), go_to);
  if (touch.as_arc) {
    to_arc_feet(*curve, at->t, &start.curve.t);
  }
  return finite ? std::optional(std::move(start)) : std::nullopt;
}

}  // namespace

std::vector<PriorStart> prior_starts(const Touch& touch, CurveClass path_class,
                                     const TouchedCurve& fitted) {
  // Of the logarithm of the curvature's rate over its square, or of that itself where it is small:
  // shapes of the lattice lie about so far apart.
  constexpr double kApart = 1.0;
  const CurveClass curve_class = touch.curve_class;
  const auto path = make_curve(path_class, fitted.shape.values);
  if (!path) {
    return {};
  }
  const LocalGeometry local = geometry(*path, fitted.shape.t);
  if (!std::isfinite(local.kappa) || !std::isfinite(local.kappa_s) || local.kappa == 0.0) {
    return {};
  }
  const Vec2 tangent = fitted.frame_T_curve.rotate(derivatives(*path, fitted.shape.t).first);
  const double sense = std::copysign(1.0, tangent.dot(touch.tangent));
  const double curvature = sense * local.kappa;
  const double log_curvature = std::log(std::abs(curvature));
  const double rate = std::asinh(local.kappa_s / (curvature * curvature));
  struct Scored {
    double score = -std::numeric_limits<double>::infinity();
    Sided shape;
  };
  std::array<Scored, kSectors> best;
  for (const PriorShape& of_prior : prior_shapes(curve_class)) {
    const double log_length = of_prior.log_curvature - log_curvature;
    if (!std::isfinite(log_length)) {
      continue;
    }
    const Sided plain{of_prior.z, of_prior.curvature, of_prior.relative_rate, 1.0, 1.0};
    for (const Sided& side : {plain, mirrored(curve_class, plain)}) {
      const Sided shape = bent_like(curvature, side);
      const double off = (shape.rate - rate) / kApart;
      const double score = of_prior.log_weight + log_of_size(log_length) - 0.5 * off * off;
      Scored& in_sector = best[sector_of(curve_class, shape)];
      if (score > in_sector.score) {
        in_sector = {score, shape};
        in_sector.shape.z[0] += log_length;
      }
    }
  }
  std::sort(best.begin(), best.end(),
            [](const Scored& a, const Scored& b) { return a.score > b.score; });
  std::vector<AlongPath> feet;
  feet.reserve(fitted.t.size());
  for (std::size_t i = 0; i < fitted.t.size(); ++i) {
    feet.push_back({i, sense * rough_arc_length(*path, fitted.shape.t, fitted.t[i])});
    if (!std::isfinite(feet.back().s)) {
      return {};
    }
  }
  std::sort(feet.begin(), feet.end(),
            [](const AlongPath& a, const AlongPath& b) { return a.s < b.s; });
  std::vector<PriorStart> starts;
  if (curve_class == CurveClass::CubicSpline) {
    Touch as_arc = touch;
    as_arc.as_arc = true;
    if (auto start = start_at(as_arc, arc_like(curvature, local.kappa_s), feet)) {
      starts.push_back(*std::move(start));
    }
  }
  for (const Scored& scored : best) {
    if (!std::isfinite(scored.score) || starts.size() == kMostStarts) {
      break;
    }
    if (auto start = start_at(touch, scored.shape, feet)) {
      starts.push_back(*std::move(start));
    }
  }
  return starts;
}

// Where it is not straight a curve keeps the side that it bends to, and so its sense of travel.
// Arcs have that half of the spline's prior which has no arms.
std::size_t arm_of(const Touch& along, const Touch& touch, const TouchedCurve& mode) {
  constexpr std::size_t kArcs = 4;
  const bool with = touch.tangent.dot(along.tangent) > 0.0;
  const bool ahead = mode.shape.t > 0.0;
  if (touch.as_arc) {
    return kArcs;
  }
  switch (touch.curve_class) {
    case CurveClass::CubicalParabola:  // half a turn takes it to itself
      return (with == ahead ? 1U : 0U) + (touch.shape.values[0] > 0.0 ? 2U : 0U) +
             (mode.z[1] > 0.0 ? 4U : 0U);
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      return (with ? 1U : 0U) + (ahead ? 2U : 0U);
    default:
      return 0;
  }
}

}  // namespace palpate
