#include "tests/support/random_scene.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/support/test_rng.h"

namespace palpate::test {
namespace {

/// A piece of a curve: position over [t0, t1]. Parameters scale as a^power with lengths.
struct Piece {
  std::function<Vec2(double)> position;
  double t0 = 0.0;
  double t1 = 1.0;
  double gap = -1.0;  ///< parameters nearer to 0 than this (a cusp) are left out; -1 = none
};

Piece piece_of(CurveClass curve_class, const Eigen::Vector3d& v, double reach) {
  const double a = v[0];
  const double b = v[1];
  const double c = v[2];
  switch (curve_class) {
    case CurveClass::Line:
      return {[](double t) { return Vec2(t, 0.0); }, -reach, reach};
    case CurveClass::Circle:
      return {[=](double t) { return Vec2(a * std::cos(t), a * std::sin(t)); }, 0.0, 2.0 * kPi};
    case CurveClass::Ellipse:
      return {[=](double t) { return Vec2(a * std::cos(t), b * std::sin(t)); }, 0.0, 2.0 * kPi};
    case CurveClass::Parabola:
      return {[=](double t) { return Vec2(a * t * t, 2.0 * a * t); }, -2.0, 2.0};
    case CurveClass::Hyperbola:
      return {[=](double t) { return Vec2(a * std::cosh(t), b * std::sinh(t)); }, -1.5, 1.5};
    case CurveClass::CubicalParabola:
      return {[=](double t) { return Vec2(t, a * t * t * t + b * t); }, -reach, reach};
    case CurveClass::SemiCubicalParabola:
      return {[=](double t) { return Vec2(t * t, a * t * t * t + b * t * t); }, -reach, reach,
              0.12 * reach};
    default:
      return {[=](double t) { return Vec2(t * t, a * t * t * t + b * t * t + c * t); }, -reach,
              reach};
  }
}

/// A shape of unit size (before scaling) and the range of the parameter.
std::pair<Eigen::Vector3d, double> random_shape(CurveClass curve_class, std::mt19937_64& rng) {
  switch (curve_class) {
    case CurveClass::Line:
      return {{0.0, 0.0, 0.0}, 1.0};
    case CurveClass::Circle:
      return {{1.0, 0.0, 0.0}, 1.0};
    case CurveClass::Ellipse:
      return {{1.0, uniform(rng, 0.3, 0.95), 0.0}, 1.0};
    case CurveClass::Parabola:
      return {{uniform(rng, 0.2, 1.0), 0.0, 0.0}, 1.0};
    case CurveClass::Hyperbola:
      return {{uniform(rng, 0.3, 2.0), uniform(rng, 0.3, 2.0), 0.0}, 1.0};
    case CurveClass::CubicalParabola: {
      const double a = random_sign(rng) * uniform(rng, 0.3, 3.0);
      return {{a, uniform(rng, -1.0, 1.0), 0.0}, 1.2 / std::sqrt(std::abs(a))};
    }
    case CurveClass::SemiCubicalParabola:
      return {{uniform(rng, 0.5, 3.0), uniform(rng, -1.0, 1.0), 0.0}, 1.2};
    default:
      return {{uniform(rng, 0.5, 3.0), uniform(rng, -1.0, 1.0),
               random_sign(rng) * uniform(rng, 0.15, 1.5)},
              1.3};
  }
}

/// Canonical parameters of the curve enlarged by s.
Eigen::Vector3d scaled(CurveClass curve_class, const Eigen::Vector3d& v, double s) {
  switch (curve_class) {
    case CurveClass::CubicalParabola:
      return {v[0] / (s * s), v[1], 0.0};
    case CurveClass::SemiCubicalParabola:
      return {v[0] / std::sqrt(s), v[1], 0.0};
    case CurveClass::CubicSpline:
      return {v[0] / std::sqrt(s), v[1], v[2] * std::sqrt(s)};
    default:
      return v * s;
  }
}

/// Parameter on the enlarged curve of a parameter of the original.
double scaled_t(CurveClass curve_class, double t, double s) {
  switch (curve_class) {
    case CurveClass::Line:
    case CurveClass::CubicalParabola:
      return t * s;
    case CurveClass::SemiCubicalParabola:
    case CurveClass::CubicSpline:
      return t * std::sqrt(s);
    default:
      return t;
  }
}

/// Arc length by parameter in a fine table.
struct ArcTable {
  std::vector<double> t, s;
  double half_diagonal = 0.0;

  explicit ArcTable(const Piece& piece) {
    constexpr int kSteps = 4000;
    Vec2 low = piece.position(piece.t0);
    Vec2 high = low;
    Vec2 before = low;
    double arc = 0.0;
    for (int i = 0; i <= kSteps; ++i) {
      const double ti = piece.t0 + (piece.t1 - piece.t0) * i / kSteps;
      const Vec2 p = piece.position(ti);
      arc += (p - before).norm();
      before = p;
      t.push_back(ti);
      s.push_back(arc);
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    half_diagonal = 0.5 * (high - low).norm();
  }

  double parameter_at(double arc) const {
    const auto upper = std::upper_bound(s.begin(), s.end(), arc);
    const auto i =
        std::clamp<std::ptrdiff_t>(upper - s.begin(), 1, static_cast<std::ptrdiff_t>(s.size()) - 1);
    const auto k = static_cast<std::size_t>(i);
    const double span = s[k] - s[k - 1];
    const double f = span > 0.0 ? (arc - s[k - 1]) / span : 0.0;
    return t[k - 1] + f * (t[k] - t[k - 1]);
  }
};

/// Arc of a patch on a piece with the arc `total` and the half diagonal `size`.
double random_arc(const SceneOptions& options, double total, double size, std::mt19937_64& rng) {
  if (options.most_arc_over_size > 0.0) {
    return size * log_uniform(rng, options.least_arc_over_size, options.most_arc_over_size);
  }
  return total * uniform(rng, options.least_fraction, options.most_fraction);
}

/// False if a patch finds no place beside the cusp.
bool touch(const Piece& piece, const SceneOptions& options, double scale, std::mt19937_64& rng,
           Scene* scene) {
  constexpr int kMostTries = 100000;
  const ArcTable table(piece);
  const double total = table.s.back();
  std::normal_distribution<double> noise(0.0, scene->sigma_m);
  for (int p = 0; p < options.patches; ++p) {
    const double stratum = total / options.patches;
    double begin = 0.0;
    double end = 0.0;
    for (int tries = 0;; ++tries) {
      if (tries == kMostTries) {
        return false;
      }
      const double arc =
          std::min(random_arc(options, total, options.size_m / scale, rng), 0.98 * stratum);
      begin = p * stratum + uniform(rng, 0.0, stratum - arc);
      end = begin + arc;
      const double t_begin = table.parameter_at(begin);
      const double t_end = table.parameter_at(end);
      if (options.across_cusp || piece.gap < 0.0 || t_begin > piece.gap || t_end < -piece.gap) {
        break;
      }
    }
    if (random_sign(rng) < 0.0) {
      std::swap(begin, end);
    }
    std::vector<Vec2> samples;
    std::vector<double> parameters;
    for (int i = 0; i < options.points_per_patch; ++i) {
      const double arc = begin + (end - begin) * i / (options.points_per_patch - 1);
      const double t = table.parameter_at(arc);
      Vec2 world = scene->world_T_curve * Vec2(scale * piece.position(t));
      // in a statement of its own, because the order of evaluating arguments differs between
      // compilers
      const double y = noise(rng);
      world += Vec2(noise(rng), y);
      samples.push_back(world);
      parameters.push_back(t);
    }
    scene->patches.push_back(std::move(samples));
    scene->t.push_back(std::move(parameters));
  }
  std::vector<std::size_t> order(scene->patches.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = i;
  }
  std::shuffle(order.begin(), order.end(), rng);
  Scene shuffled = *scene;
  for (std::size_t i = 0; i < order.size(); ++i) {
    shuffled.patches[i] = scene->patches[order[i]];
    shuffled.t[i] = scene->t[order[i]];
  }
  *scene = std::move(shuffled);
  return true;
}

Pose2 random_pose(const SceneOptions& options, std::mt19937_64& rng) {
  return {uniform(rng, -10.0, 10.0) * options.size_m, uniform(rng, -10.0, 10.0) * options.size_m,
          uniform(rng, -kPi, kPi)};
}

/// The scene without touches: the curve of that shape, enlarged by `scale`, at a random pose.
Scene untouched(CurveClass curve_class, const Eigen::Vector3d& shape, double scale,
                const SceneOptions& options, std::mt19937_64& rng) {
  Scene scene;
  scene.curve_class = curve_class;
  scene.values = scaled(curve_class, shape, scale);
  scene.world_T_curve = random_pose(options, rng);
  scene.sigma_m = options.sigma_over_size * options.size_m;
  return scene;
}

}  // namespace

Scene random_scene(CurveClass curve_class, const SceneOptions& options, std::mt19937_64& rng) {
  const auto [shape, reach] = random_shape(curve_class, rng);
  const Piece piece = piece_of(curve_class, shape, reach);
  const double scale = options.size_m / ArcTable(piece).half_diagonal;
  Scene scene = untouched(curve_class, shape, scale, options, rng);
  if (!touch(piece, options, scale, rng, &scene)) {
    return random_scene(curve_class, options, rng);
  }
  for (auto& patch : scene.t) {
    for (double& t : patch) {
      t = scaled_t(curve_class, t, scale);
    }
  }
  return scene;
}

Scene random_ellipse_arc(double arc_rad, const SceneOptions& options, std::mt19937_64& rng) {
  const auto [shape, reach] = random_shape(CurveClass::Ellipse, rng);
  Piece piece = piece_of(CurveClass::Ellipse, shape, reach);
  const double scale = options.size_m / ArcTable(piece).half_diagonal;
  Scene scene = untouched(CurveClass::Ellipse, shape, scale, options, rng);
  piece.t0 = uniform(rng, 0.0, 2.0 * kPi);
  piece.t1 = piece.t0 + arc_rad;
  SceneOptions whole = options;
  whole.least_fraction = whole.most_fraction = 1.0;
  touch(piece, whole, scale, rng, &scene);
  return scene;
}

Scene random_outside_scene(OutsideShape shape, const SceneOptions& options, std::mt19937_64& rng) {
  Piece piece;
  const double u = uniform(rng, 0.0, 1.0);
  switch (shape) {
    case OutsideShape::Sinusoid:
      piece = {[=](double t) { return Vec2(t, (0.3 + u) * std::sin(t)); }, 0.0, 3.0 * kPi};
      break;
    case OutsideShape::Superellipse: {
      const double exponent = 2.0 / (3.0 + 2.0 * u);
      const auto power = [=](double x) {
        return std::copysign(std::pow(std::abs(x), exponent), x);
      };
      piece = {[=](double t) { return Vec2(power(std::cos(t)), 0.7 * power(std::sin(t))); }, 0.0,
               2.0 * kPi};
      break;
    }
    case OutsideShape::LogSpiral:
      piece = {[=](double t) {
                 return Vec2(std::exp((0.1 + 0.15 * u) * t) * Vec2(std::cos(t), std::sin(t)));
               },
               0.0, 2.5 * kPi};
      break;
    case OutsideShape::Quartic:
      piece = {[=](double t) {
                 return Vec2(t, (0.5 + u) * t * t * t * t - (0.8 + 0.4 * u) * t * t + 0.2 * t);
               },
               -1.2, 1.2};
      break;
  }
  Scene scene;
  const double scale = options.size_m / ArcTable(piece).half_diagonal;
  scene.world_T_curve = random_pose(options, rng);
  scene.sigma_m = options.sigma_over_size * options.size_m;
  touch(piece, options, scale, rng, &scene);
  return scene;
}

}  // namespace palpate::test
