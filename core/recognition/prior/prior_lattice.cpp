#include "core/recognition/prior/prior_lattice.h"

#include <array>
#include <cmath>

#include "core/curves/curve.h"
#include "core/recognition/prior/arms.h"
#include "core/recognition/prior/touched_prior.h"

namespace palpate {
namespace {

/// Points of a lattice rule in the unit cube, i -> ((i + 1/2) / n) (1, a, a^2 mod n): a of least
/// error for these integrals among all of so many points. [1]
struct Lattice {
  int points = 1;
  int generator = 1;
};

/// As many as leave an error of about a tenth, at any noise; a fifth of the spline's evidence.
Lattice lattice_of(int dimensions) {
  switch (dimensions) {
    case 0:
      return {1, 1};
    case 1:
      return {12, 1};
    case 2:
      return {34, 9};
    default:
      return {127, 81};
  }
}

/// A coordinate's value and how fast the unit interval's runs there.
struct Mapped {
  double value = 0.0;
  double rate = 1.0;
};

/// [0, 1] to itself, slow at both ends: what is periodic so, a lattice integrates well (I. Sloan
/// and S. Joe, "Lattice methods for multiple integration", 1994).
Mapped slow_at_ends(double u) { return {u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u)}; }

/// [0, 1] to angles in [from, to], and those to their tangents.
Mapped tangent(double u, double from, double to, double scale) {
  const Mapped part = slow_at_ends(u);
  const double value = std::tan(from + (to - from) * part.value);
  return {scale * value, scale * (to - from) * (1.0 + value * value) * part.rate};
}
/// Everywhere; one side of 0, where the other is its image in a mirror.
Mapped everywhere(double u, double scale) { return tangent(u, -0.5 * kPi, 0.5 * kPi, scale); }
Mapped one_side(double u, double scale) { return tangent(u, 0.0, 0.5 * kPi, scale); }

/// The coordinates of a shape but its size, and what of the cube one of the space about it takes.
struct Place {
  TouchedVector z = TouchedVector::Zero();
  double rate = 1.0;
};

/// Of a point of the unit cube. Dense where curvature passes through 0.
Place place_of_bend(CurveClass curve_class, const std::array<double, 3>& u) {
  Place place;
  place.z = prior_centre({curve_class});
  // Twice the width of a normal law as high is where the tails begin.
  const TouchedVector scale = 2.0 * prior_widths({curve_class}, place.z);
  const auto set = [&](int k, const Mapped& mapped) {
    place.z[k] = mapped.value;
    place.rate *= mapped.rate;
  };
  switch (curve_class) {
    case CurveClass::Ellipse: {
      set(1, slow_at_ends(u[0]));
      // Evenly in the eccentric angle, as the perimeter nearly is; the part keeps its size.
      const Mapped part = slow_at_ends(u[1]);
      const double angle = 0.5 * kPi * part.value;
      const double ratio = std::sqrt(place.z[1]);
      const double x = std::sin(angle);
      const double y = ratio * std::cos(angle);
      set(2, {std::atan2(y, x), 0.5 * kPi * part.rate * ratio / (x * x + y * y)});
      break;
    }
    case CurveClass::Parabola:
      set(1, one_side(u[0], scale[1]));
      break;
    case CurveClass::Hyperbola: {
      const Mapped away = tangent(u[0], -0.25 * kPi, 0.5 * kPi, 1.0);  // of m from 1, m > 0
      set(1, {1.0 + away.value, away.rate});
      set(2, one_side(u[1], scale[2]));
      break;
    }
    case CurveClass::CubicalParabola:
    case CurveClass::SemiCubicalParabola:
      set(1, everywhere(u[0], scale[1]));
      set(2, one_side(u[1], scale[2]));
      break;
    case CurveClass::CubicSpline: {
      set(1, everywhere(u[0], scale[1]));
      set(2, one_side(u[1], scale[2]));
      // On either side of the inflection, 3 (a t)^2 = a c.
      const double inflection = 3.0 * place.z[2] * place.z[2];
      const double side = u[2] < 0.5 ? -1.0 : 1.0;
      const Mapped away = one_side(std::abs(2.0 * u[2] - 1.0), std::hypot(scale[3], inflection));
      set(3, {inflection + side * away.value, away.rate});
      break;
    }
    default:
      break;
  }
  return place;
}

/// The same of a part that is touched on its arms.
Place place_on_arms(CurveClass curve_class, const std::array<double, 3>& u) {
  Place place;
  const auto set = [&](int k, const Mapped& mapped) {
    place.z[k] = mapped.value;
    place.rate *= mapped.rate;
  };
  const auto scale = [&](int k) { return 2.0 * width_on_arms(curve_class, k); };
  switch (curve_class) {
    case CurveClass::Parabola:
      set(1, one_side(u[0], scale(1)));
      break;
    case CurveClass::Ellipse: {
      set(1, slow_at_ends(u[0]));
      const Mapped slope = one_side(u[1], scale(2));
      set(2, {std::atan2(1.0, slope.value), slope.rate / (1.0 + slope.value * slope.value)});
      break;
    }
    case CurveClass::Hyperbola: {
      const Mapped root = one_side(u[0], 1.0);  // of m: the tangent of half the angle
      const double w_over_place = std::hypot(1.0, root.value) / root.value;
      const Mapped at = one_side(u[1], scale(2));  // y / b
      set(1, {root.value * root.value, 2.0 * root.value * root.rate});
      set(2, {w_over_place * at.value, w_over_place * at.rate});
      break;
    }
    default:
      set(1, everywhere(u[0], scale(1)));
      set(2, one_side(u[1], scale(2)));
      break;
  }
  return place;
}

/// The shapes of a lattice's points of parts touched there. Their weights sum to `share`.
std::vector<PriorShape> shapes_of(CurveClass curve_class, TouchedAt where, double share) {
  const int own = shape_coordinates(curve_class);
  const Lattice lattice = lattice_of(own - 1);
  const TouchedShape like{Eigen::Vector3d::Ones(), 0.0};
  std::vector<PriorShape> shapes;
  double sum = 0.0;
  for (int i = 0; i < lattice.points; ++i) {
    std::array<double, 3> u{};
    double at = (i + 0.5) / lattice.points;
    for (double& part : u) {
      part = at - std::floor(at);
      at = lattice.generator * part;
    }
    Place place =
        where == TouchedAt::Bend ? place_of_bend(curve_class, u) : place_on_arms(curve_class, u);
    place.z[0] = expected_log_length(curve_class, where, place.z);
    const auto shape = shape_at({curve_class}, place.z, like);
    const auto curve = shape ? make_curve(curve_class, shape->values) : std::nullopt;
    if (!curve || !(place.rate > 0.0)) {
      continue;  // an end of the cube
    }
    const LocalGeometry local = geometry(*curve, shape->t);
    const TouchedVector widths = prior_widths({curve_class}, place.z);
    const double weight = place.rate * std::exp(log_prior_touched_at(curve_class, where, place.z)) /
                          widths.segment(1, own - 1).prod();
    if (std::isfinite(local.kappa) && std::isfinite(local.kappa_s) && std::isfinite(weight)) {
      shapes.push_back({place.z, local.kappa, local.kappa_s, weight});
      sum += weight;
    }
  }
  for (PriorShape& shape : shapes) {
    shape.weight *= share / sum;
    shape.log_weight = std::log(shape.weight);
    shape.log_curvature = std::log(std::abs(shape.curvature));
    shape.relative_rate = std::asinh(shape.rate / (shape.curvature * shape.curvature));
  }
  return shapes;
}

std::vector<PriorShape> shapes_of(CurveClass curve_class) {
  if (!has_arms(curve_class)) {
    return shapes_of(curve_class, TouchedAt::Bend, 1.0);
  }
  std::vector<PriorShape> shapes = shapes_of(curve_class, TouchedAt::Bend, 1.0 - kShareOfArms);
  const auto on_arms = shapes_of(curve_class, TouchedAt::Arms, kShareOfArms);
  shapes.insert(shapes.end(), on_arms.begin(), on_arms.end());
  return shapes;
}

}  // namespace

const std::vector<PriorShape>& prior_shapes(CurveClass curve_class) {
  static const auto all = [] {
    ByClass<std::vector<PriorShape>> result;
    for (const CurveClass each : kCurveClasses) {
      if (each != CurveClass::Line) {
        result[each] = shapes_of(each);
      }
    }
    return result;
  }();
  return all[curve_class];
}

}  // namespace palpate
