#include "core/recognition/given/given_class.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/curves/curve.h"
#include "core/recognition/given/descent.h"
#include "core/recognition/given/given_starts.h"

namespace palpate {
namespace {

using Exact = DoubleDouble;

/// The points in use about their middle, in units of about their half extent. Differences are
/// formed in twice a double's precision, and the unit is a power of 4, whose root scales exactly
/// too: nothing of the points is lost however far from the origin they lie.
struct LocalPoints {
  Vec2 middle_m = Vec2::Zero();
  double unit_m = 1.0;
  std::vector<std::size_t> index;  ///< of every point in use
  std::vector<WeighedPoint<Exact>> exact;
  std::vector<Vec2> rough;
  std::size_t normals = 0;  ///< that count
  /// Rounding of the coordinates: no point is known better.
  double rounding = 0.0;
};

/// Noise of a point, the same in all directions; 0 where it is not known. [m]
double noise_of(const GivenPoint& point, double default_sigma_m) {
  const Eigen::Vector3d& c = point.covariance_m2;
  if (c.x() > 0.0) {
    return std::sqrt(0.5 * (c.x() + c.z()));
  }
  return point.sigma_m > 0.0 ? point.sigma_m : default_sigma_m;
}

bool has_normal(const GivenPoint& point) { return point.normal_sigma_rad > 0.0; }

/// Every number finite, every noise a noise.
bool is_sound(const GivenPoint& point) {
  const Eigen::Vector3d& c = point.covariance_m2;
  const bool covariance = c.isZero(0.0) || (c.x() > 0.0 && c.x() * c.z() > c.y() * c.y());
  const bool normal = point.normal_sigma_rad == 0.0 ||
                      (point.normal_sigma_rad > 0.0 && point.normal.squaredNorm() > 0.0);
  return point.position_m.allFinite() && point.into_material.allFinite() &&
         point.normal.allFinite() && c.allFinite() && point.sigma_m >= 0.0 &&
         std::isfinite(point.sigma_m) && point.tip_radius_m >= 0.0 &&
         std::isfinite(point.tip_radius_m) && std::isfinite(point.normal_sigma_rad) && covariance &&
         normal;
}

std::optional<LocalPoints> local_points(std::span<const GivenPoint> points, double sigma_m,
                                        bool weighted) {
  LocalPoints local;
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 high = -low;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].set_aside) {
      local.index.push_back(i);
      low = low.cwiseMin(points[i].position_m);
      high = high.cwiseMax(points[i].position_m);
    }
  }
  const double half_extent = 0.5 * (high - low).maxCoeff();
  if (local.index.empty() || !(half_extent > 0.0)) {
    return std::nullopt;
  }
  local.middle_m = low + 0.5 * (high - low);
  local.unit_m = std::ldexp(1.0, 2 * static_cast<int>(std::lround(0.5 * std::log2(half_extent))));
  constexpr double kRoundings = 4.0;  // a few half units in the last place meet in a residual
  local.rounding = kRoundings * std::numeric_limits<double>::epsilon() *
                   low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff() / local.unit_m;
  const Exact inverse_unit(1.0 / local.unit_m);
  for (const std::size_t i : local.index) {
    const GivenPoint& point = points[i];
    WeighedPoint<Exact> exact;
    exact.position.x = inverse_unit * (Exact(point.position_m.x()) - Exact(local.middle_m.x()));
    exact.position.y = inverse_unit * (Exact(point.position_m.y()) - Exact(local.middle_m.y()));
    exact.weight = weighted ? Exact(local.unit_m) / Exact(noise_of(point, sigma_m)) : Exact(1.0);
    exact.offset = inverse_unit * Exact(point.tip_radius_m);
    if (weighted && has_normal(point)) {
      const Vec2 normal = point.normal.normalized();
      exact.normal = {Exact(normal.x()), Exact(normal.y())};
      exact.normal_weight = Exact(1.0) / Exact(point.normal_sigma_rad);
      ++local.normals;
    }
    local.exact.push_back(exact);
    local.rough.emplace_back(to_double(exact.position.x), to_double(exact.position.y));
  }
  return local;
}

std::size_t different(std::vector<Vec2> points) {
  const auto less = [](const Vec2& u, const Vec2& v) {
    return u.x() < v.x() || (u.x() == v.x() && u.y() < v.y());
  };
  std::sort(points.begin(), points.end(), less);
  return static_cast<std::size_t>(std::unique(points.begin(), points.end()) - points.begin());
}

/// Whether one straight line holds all points to the rounding of their coordinates.
bool on_one_line(const LocalPoints& local) {
  const auto farthest = [&](const Vec2& from) {
    return *std::max_element(local.rough.begin(), local.rough.end(),
                             [&](const Vec2& u, const Vec2& v) {
                               return (u - from).squaredNorm() < (v - from).squaredNorm();
                             });
  };
  const Vec2 one_end = farthest(local.rough.front());
  const Vec2 along = (farthest(one_end) - one_end).normalized();
  return std::all_of(local.rough.begin(), local.rough.end(), [&](const Vec2& p) {
    return std::abs(cross(along, p - one_end)) <= local.rounding;
  });
}

/// The points that show a start as well as all do, in double precision.
std::vector<WeighedPoint<double>> some(std::span<const WeighedPoint<double>> all,
                                       std::size_t most) {
  const std::size_t stride = (all.size() + most - 1) / most;
  std::vector<WeighedPoint<double>> points;
  for (std::size_t i = 0; i < all.size(); i += stride) {
    points.push_back(all[i]);
  }
  return points;
}

PlaneVector<double> parameter_at(CurveClass curve_class, double t) {
  switch (curve_class) {
    case CurveClass::Circle:
    case CurveClass::Ellipse:
      return {std::cos(t), std::sin(t)};
    case CurveClass::Hyperbola:
      return {std::sinh(t), 0.0};
    default:
      return {t, 0.0};
  }
}

double t_at(CurveClass curve_class, const PlaneVector<double>& parameter) {
  switch (curve_class) {
    case CurveClass::Circle:
    case CurveClass::Ellipse:
      return std::atan2(parameter.y, parameter.x);
    case CurveClass::Hyperbola:
      return std::asinh(parameter.x);
    default:
      return parameter.x;
  }
}

template <typename T>
std::optional<Curve> curve_of(const PlacedCurve<T>& placed) {
  // Beyond so many half extents a conic cannot be told from its limit, nor a circle from a line.
  constexpr double kFarthest = 1e7;
  Eigen::Vector3d values;
  for (int i = 0; i < 3; ++i) {
    values[i] = to_double(placed.shape[i]);
  }
  if (!(values.cwiseAbs().maxCoeff() < kFarthest)) {
    return std::nullopt;
  }
  return make_curve(placed.curve_class, values);
}

/// Puts every foot at the nearest point of the whole curve.
bool seat_globally(PlacedCurve<double>* placed, std::span<const WeighedPoint<double>> points) {
  const auto curve = curve_of(*placed);
  if (!curve) {
    return false;
  }
  placed->feet.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PlaneVector<double> p = placed->to_curve(points[i].position);
    const FootPoint foot = foot_point(*curve, {p.x, p.y});
    if (!std::isfinite(foot.distance)) {
      return false;
    }
    placed->feet[i] = parameter_at(placed->curve_class, foot.t);
  }
  return true;
}

struct Candidate {
  PlacedCurve<double> curve;
  double cost = std::numeric_limits<double>::infinity();
  bool settled = false;
  int side = 0;
};

/// Settled before unsettled, then the lower cost.
bool is_better(const Candidate& u, const Candidate& v) {
  return u.settled != v.settled ? u.settled : u.cost < v.cost;
}

void descend_on(std::span<const WeighedPoint<double>> points, const DescentEffort& effort,
                Candidate* candidate) {
  const auto seat = [&](PlacedCurve<double>* trial) { return seat_globally(trial, points); };
  candidate->settled = false;
  candidate->cost = std::numeric_limits<double>::infinity();
  if (!seat(&candidate->curve)) {
    return;
  }
  const auto descent = descend(&candidate->curve, points, effort, seat);
  candidate->cost = descent.squares.cost;
  candidate->settled = descent.settled;
}

/// Tip centres on that side of the curve.
std::vector<WeighedPoint<double>> on_side(std::span<const WeighedPoint<Exact>> exact, int side) {
  std::vector<WeighedPoint<double>> points;
  points.reserve(exact.size());
  for (const WeighedPoint<Exact>& point : exact) {
    points.push_back({as_double(point.position), to_double(point.weight),
                      side * to_double(point.offset), as_double(point.normal),
                      to_double(point.normal_weight)});
  }
  return points;
}

/// Starts through the points; where normals are measured, through a place on either side of each
/// along its tangent too, so that fewer points than a class has unknowns have starts.
std::vector<GivenStart> starts_of(CurveClass curve_class, const LocalPoints& local) {
  std::vector<GivenStart> starts = given_starts(curve_class, local.rough);
  if (local.normals == 0) {
    return starts;
  }
  // Of the points' extent, which is about 1: there a curve has left its tangent by little.
  constexpr double kAside = 0.1;
  std::vector<Vec2> more = local.rough;
  for (const WeighedPoint<Exact>& point : local.exact) {
    if (to_double(point.normal_weight) > 0.0) {
      const PlaneVector<double> n = as_double(point.normal);
      const PlaneVector<double> p = as_double(point.position);
      more.emplace_back(p.x - kAside * n.y, p.y + kAside * n.x);
      more.emplace_back(p.x + kAside * n.y, p.y - kAside * n.x);
    }
  }
  const std::vector<GivenStart> by_normals = given_starts(curve_class, more);
  starts.insert(starts.end(), by_normals.begin(), by_normals.end());
  return starts;
}

/// The lowest minimum that any start leads to; its feet are those of all points.
Candidate search(CurveClass curve_class, const LocalPoints& local, std::span<const int> sides) {
  constexpr std::size_t kMostSeedPoints = 64;
  constexpr std::size_t kMostOnAll = 2;
  // A start that is right settles within ten steps; a valley may take a few dozen.
  constexpr DescentEffort kOnSome{60, 1e-6, 0.0};
  constexpr DescentEffort kOnAll{200, 1e-8, 0.0};
  std::vector<Candidate> found;
  const std::vector<GivenStart> starts = starts_of(curve_class, local);
  for (const int side : sides) {
    const auto all = on_side(local.exact, side);
    const auto few = some(all, kMostSeedPoints);
    for (const GivenStart& start : starts) {
      Candidate candidate;
      candidate.side = side;
      candidate.curve.curve_class = curve_class;
      for (int i = 0; i < 3; ++i) {
        candidate.curve.shape[i] = start.shape.values[i];
      }
      candidate.curve.origin = {start.pose.x, start.pose.y};
      candidate.curve.axis = {std::cos(start.pose.theta), std::sin(start.pose.theta)};
      descend_on(few, kOnSome, &candidate);
      if (std::isfinite(candidate.cost)) {
        found.push_back(std::move(candidate));
      }
    }
  }
  std::stable_sort(found.begin(), found.end(), is_better);
  Candidate best;
  for (std::size_t i = 0; i < std::min(found.size(), kMostOnAll); ++i) {
    // What ended where another did is not walked again.
    constexpr double kSame = 1e-6;
    if (i > 0 && found[i].side == found[0].side &&
        std::abs(found[i].cost - found[0].cost) <= kSame * found[0].cost) {
      continue;
    }
    descend_on(on_side(local.exact, found[i].side), kOnAll, &found[i]);
    if (is_better(found[i], best)) {
      best = std::move(found[i]);
    }
  }
  return best;
}

/// Power of the unit of length in every shape parameter's unit.
std::array<double, 3> length_powers(CurveClass curve_class) {
  switch (curve_class) {
    case CurveClass::CubicalParabola:
      return {-2.0, 0.0, 0.0};
    case CurveClass::SemiCubicalParabola:
      return {-0.5, 0.0, 0.0};
    case CurveClass::CubicSpline:
      return {-0.5, 0.0, 0.5};
    default:
      return {1.0, 1.0, 1.0};
  }
}

/// (information)^-1 of the unknowns, in their units; a direction that is not determined at all
/// gets a variance as large as doubles can tell.
SquareMatrix<Exact> inverse_of(const SquareMatrix<Exact>& information, std::size_t n) {
  constexpr double kNothing = 1e-30;
  const auto moves = unit_moves(information, n);
  const auto scaled = in_unit_moves(information, n, moves);
  auto lower = lower_factor(scaled, n, 0.0);
  for (double ridge = kNothing; !lower; ridge *= 10.0) {
    lower = lower_factor(scaled, n, ridge);
  }
  SquareMatrix<Exact> inverse{};
  for (std::size_t j = 0; j < n; ++j) {
    std::array<Exact, kMostUnknowns> unit{};
    unit[j] = Exact(1.0);
    const auto column = solve(*lower, n, unit);
    for (std::size_t i = 0; i < n; ++i) {
      inverse[i][j] = column[i] / Exact(moves[i]) / Exact(moves[j]);
    }
  }
  return inverse;
}

/// Residuals no larger than the rounding of the coordinates are as good as none.
double stationarity_of(const Squares<Exact>& squares, const LocalPoints& local, std::size_t n) {
  const auto moves = unit_moves(squares.information, n);
  const double least = local.rounding * to_double(local.exact.front().weight);
  const double length = std::max(std::sqrt(2.0 * to_double(squares.cost)), least);
  double largest = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    largest = std::max(largest, std::abs(to_double(squares.gradient[i])) / (moves[i] * length));
  }
  return largest;
}

/// The sides that tips may lie on: what the points say of their material rules.
std::vector<int> sides_of(std::span<const GivenPoint> points) {
  const bool tips = std::any_of(points.begin(), points.end(), [](const GivenPoint& point) {
    return point.tip_radius_m > 0.0 && !point.set_aside;
  });
  return tips ? std::vector<int>{1, -1} : std::vector<int>{0};
}

/// How far the points' word on their material speaks against the side, in points.
int votes_against(const Candidate& candidate, const LocalPoints& local,
                  std::span<const GivenPoint> points) {
  int votes = 0;
  for (std::size_t k = 0; k < local.index.size(); ++k) {
    const GivenPoint& point = points[local.index[k]];
    const Vec2 into = point.into_material.isZero() ? Vec2(-point.normal) : point.into_material;
    if (into.isZero()) {
      continue;
    }
    const auto place_of = canonical_point(candidate.curve.curve_class, candidate.curve.shape,
                                          candidate.curve.feet[k]);
    const PlaneVector<double> local_into{inner(candidate.curve.axis, {into.x(), into.y()}),
                                         inner(left(candidate.curve.axis), {into.x(), into.y()})};
    // The centre lies opposite the material.
    votes += candidate.side * inner(left(place_of.first), local_into) > 0.0 ? 1 : -1;
  }
  return votes;
}

/// Of both sides, the one that the points' material tells, else the better one.
Candidate search_sides(CurveClass curve_class, const LocalPoints& local,
                       std::span<const GivenPoint> points) {
  Candidate best;
  int best_votes = 0;
  for (const int side : sides_of(points)) {
    Candidate candidate = search(curve_class, local, std::array{side});
    if (!std::isfinite(candidate.cost)) {
      continue;
    }
    const int votes = side == 0 ? 0 : votes_against(candidate, local, points);
    if (!std::isfinite(best.cost) || votes < best_votes ||
        (votes == best_votes && is_better(candidate, best))) {
      best = std::move(candidate);
      best_votes = votes;
    }
  }
  return best;
}

/// A line slides freely: its origin is where it lies nearest to the points' mean.
void slide_to_mean(const LocalPoints& local, PlacedCurve<double>* line) {
  Vec2 sum = Vec2::Zero();
  for (const Vec2& point : local.rough) {
    sum += point;
  }
  const Vec2 mean = sum / static_cast<double>(local.rough.size());
  const double along = line->to_curve({mean.x(), mean.y()}).x;
  line->origin = line->origin + along * line->axis;
  for (PlaneVector<double>& foot : line->feet) {
    foot.x -= along;
  }
}

PlacedCurve<Exact> exact_of(const PlacedCurve<double>& curve) {
  PlacedCurve<Exact> exact;
  exact.curve_class = curve.curve_class;
  for (int i = 0; i < 3; ++i) {
    exact.shape[i] = Exact(curve.shape[i]);
  }
  exact.origin = as<Exact>(curve.origin);
  exact.axis = as<Exact>(curve.axis);
  exact.axis = Exact(1.0) / sqrt(inner(exact.axis, exact.axis)) * exact.axis;
  for (const PlaneVector<double>& foot : curve.feet) {
    exact.feet.push_back(as<Exact>(foot));
  }
  if (curve.curve_class == CurveClass::Circle || curve.curve_class == CurveClass::Ellipse) {
    for (PlaneVector<Exact>& foot : exact.feet) {
      foot = Exact(1.0) / sqrt(inner(foot, foot)) * foot;
    }
  }
  return exact;
}

/// Shape, pose and covariance in metres and the world's frame.
void report_curve(const PlacedCurve<Exact>& placed, const Squares<Exact>& squares,
                  const LocalPoints& local, GivenFit* fit) {
  const Unknowns unknowns(placed.curve_class);
  const auto n = static_cast<std::size_t>(unknowns.count);
  const std::array<double, 3> powers = length_powers(placed.curve_class);
  std::array<double, 3> units{};
  fit->shape.curve_class = placed.curve_class;
  for (std::size_t i = 0; i < 3; ++i) {
    units[i] = std::pow(local.unit_m, powers[i]);  // a power of 2: exact
    fit->shape.values[static_cast<Eigen::Index>(i)] = to_double(Exact(units[i]) * placed.shape[i]);
  }
  const auto in_world = [&](double middle_m, const Exact& v) {
    return to_double(Exact(middle_m) + Exact(local.unit_m) * v);
  };
  fit->world_T_curve.x = in_world(local.middle_m.x(), placed.origin.x);
  fit->world_T_curve.y = in_world(local.middle_m.y(), placed.origin.y);
  Vec2 axis(to_double(placed.axis.x), to_double(placed.axis.y));
  fit->world_T_curve.theta =
      placed.curve_class == CurveClass::Circle ? 0.0 : std::atan2(axis.y(), axis.x());

  // [shape; x; y; theta] = this times the unknowns.
  const Eigen::Index rows = unknowns.shape + 3;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6> by(rows,
                                                                    static_cast<Eigen::Index>(n));
  by.setZero();
  for (int i = 0; i < unknowns.shape; ++i) {
    by(i, i) = units[static_cast<std::size_t>(i)];
  }
  if (unknowns.x >= 0) {
    by.block<2, 1>(unknowns.shape, unknowns.x) = local.unit_m * axis;
  }
  by.block<2, 1>(unknowns.shape, unknowns.y) = local.unit_m * left_of(axis);
  if (unknowns.angle >= 0) {
    by(rows - 1, unknowns.angle) = 1.0;
  }
  const SquareMatrix<Exact> inverse = inverse_of(squares.information, n);
  ShapePoseCovariance of_unknowns(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  bool open = false;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      of_unknowns(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          to_double(inverse[i][j]);
    }
    // Where the rounding of the coordinates alone leaves a shape parameter open by all of itself.
    const double size = i < 3 && powers[i] == 0.0 ? 1.0 : std::abs(to_double(placed.shape[i % 3]));
    const double weight = to_double(local.exact.front().weight);
    open = open || (i < static_cast<std::size_t>(unknowns.shape) &&
                    weight * local.rounding * std::sqrt(to_double(inverse[i][i])) > size);
  }
  fit->covariance = by * of_unknowns * by.transpose();
  if (open) {
    fit->status = GivenStatus::NotDetermined;
  }
}

void report_residuals(PlacedCurve<Exact>* placed, const LocalPoints& local,
                      std::span<const GivenPoint> points, GivenFit* fit) {
  const auto curve = curve_of(*placed);
  fit->residuals.resize(points.size());
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  Exact squares(0.0);
  std::size_t used = 0;
  const Vec2 axis(to_double(placed->axis.x), to_double(placed->axis.y));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Exact inverse_unit(1.0 / local.unit_m);
    const PlaneVector<Exact> p = placed->to_curve(
        {inverse_unit * (Exact(points[i].position_m.x()) - Exact(local.middle_m.x())),
         inverse_unit * (Exact(points[i].position_m.y()) - Exact(local.middle_m.y()))});
    PlaneVector<Exact> foot;
    if (points[i].set_aside) {
      const Vec2 rough(to_double(p.x), to_double(p.y));
      foot = as<Exact>(parameter_at(placed->curve_class, foot_point(*curve, rough).t));
    } else {
      foot = placed->feet[used];
    }
    const Placement<Exact> there = place(*placed, p, &foot);
    const Exact distance =
        Exact(local.unit_m) * there.distance - Exact(fit->side * points[i].tip_radius_m);
    GivenResidual& residual = fit->residuals[i];
    residual.t = t_at(placed->curve_class, as_double(foot));
    residual.distance_m = to_double(distance);
    const Vec2 at(to_double(there.foot.position.x), to_double(there.foot.position.y));
    const Vec2 local_foot = axis * at.x() + left_of(axis) * at.y() +
                            Vec2(to_double(placed->origin.x), to_double(placed->origin.y));
    residual.foot_m = local.middle_m + local.unit_m * local_foot;
    if (has_normal(points[i]) && to_double(there.speed) > 0.0) {
      const Vec2 normal = points[i].normal.normalized();
      const Exact miss = normal_miss(*placed, there, {Exact(normal.x()), Exact(normal.y())});
      residual.normal_rad = 2.0 * std::atan(0.5 * to_double(miss));
    }
    if (!points[i].set_aside) {
      ++used;
      squares = squares + distance * distance;
      lowest = std::min(lowest, residual.distance_m);
      highest = std::max(highest, residual.distance_m);
    }
  }
  fit->rms_m = std::sqrt(to_double(squares) / static_cast<double>(used));
  fit->peak_to_valley_m = highest - lowest;
}

/// A line along the order of the points; of two poses that are the same, the one nearer to the
/// world's axes.
void settle_pose(std::span<const GivenPoint> points, const LocalPoints& local, GivenFit* fit) {
  Pose2& pose = fit->world_T_curve;
  if (fit->shape.curve_class == CurveClass::Line) {
    const Vec2 first = points[local.index.front()].position_m;
    const Vec2 last = points[local.index.back()].position_m;
    if (pose.rotate_back(last - first).x() < 0.0) {
      pose.theta = wrap_angle(pose.theta + kPi);
      for (GivenResidual& residual : fit->residuals) {
        residual.t = -residual.t;
        residual.distance_m = -residual.distance_m;
      }
      fit->side = -fit->side;
    }
  } else if (pose_symmetry(fit->shape.curve_class) == 2 && std::abs(pose.theta) > 0.5 * kPi) {
    pose.theta = wrap_angle(pose.theta + kPi);
    const bool closed = fit->shape.curve_class == CurveClass::Ellipse;
    for (GivenResidual& residual : fit->residuals) {
      // A cubical parabola's other half; there increasing t runs the other way.
      residual.t = closed ? wrap_angle(residual.t + kPi) : -residual.t;
      residual.distance_m = closed ? residual.distance_m : -residual.distance_m;
    }
    fit->side = closed ? fit->side : -fit->side;
  }
}

void report_noise(std::span<const GivenPoint> points, const LocalPoints& local, bool stated,
                  double default_sigma_m, double squares, GivenFit* fit) {
  fit->sigma_stated = stated;
  fit->normals = local.normals;
  fit->dof = static_cast<int>(local.index.size() + local.normals) -
             degrees_of_freedom(fit->shape.curve_class);
  if (stated) {
    fit->chi2 = squares;
    double sum = 0.0;
    for (const std::size_t i : local.index) {
      const double own_m = noise_of(points[i], default_sigma_m);
      sum += own_m * own_m;
    }
    fit->sigma_m = std::sqrt(sum / static_cast<double>(local.index.size()));
    return;
  }
  if (fit->dof <= 0) {
    fit->covariance.diagonal().setConstant(std::numeric_limits<double>::infinity());
    return;
  }
  // The residuals are in units of length here.
  const double variance = squares / static_cast<double>(fit->dof);
  fit->chi2 = static_cast<double>(fit->dof);
  fit->sigma_m = local.unit_m * std::sqrt(variance);
  fit->covariance *= variance;
}

/// Weighs the points of stated covariance by their variance along the curve's normals at their
/// feet, and measured normals by their own variance and that of the foot's place: noise along the
/// curve puts the foot beside the touch, where the curve has turned on. Returns by what part the
/// weight that changed most did.
double weigh_at_feet(const PlacedCurve<Exact>& placed, const LocalPoints& local,
                     std::span<const GivenPoint> points, double default_sigma_m,
                     std::vector<WeighedPoint<Exact>>* exact) {
  double change = 0.0;
  const auto set = [&](const Exact& variance, Exact* weight) {
    const Exact now = Exact(1.0) / sqrt(variance);
    change = std::max(change, std::abs(to_double((now - *weight) / now)));
    *weight = now;
  };
  for (std::size_t k = 0; k < exact->size(); ++k) {
    const GivenPoint& point = points[local.index[k]];
    const Eigen::Vector3d& c = point.covariance_m2;
    if (!(c.x() > 0.0) && !has_normal(point)) {
      continue;
    }
    PlaneVector<Exact> foot = placed.feet[k];
    const auto there = place(placed, placed.to_curve((*exact)[k].position), &foot);
    if (!(to_double(there.speed) > 0.0) || !(to_double(there.slope) > 0.0)) {
      continue;
    }
    const PlaneVector<Exact> n = there.normal.x * placed.axis + there.normal.y * left(placed.axis);
    const auto variance_along = [&](const PlaneVector<Exact>& v) {
      const Exact unit2(local.unit_m * local.unit_m);  // a power of 2
      if (!(c.x() > 0.0)) {
        const Exact sigma_m(noise_of(point, default_sigma_m));
        return sigma_m * sigma_m / unit2;
      }
      return (Exact(c.x()) * v.x * v.x + Exact(2.0 * c.y()) * v.x * v.y +
              Exact(c.z()) * v.y * v.y) /
             unit2;
    };
    if (c.x() > 0.0) {
      set(variance_along(n), &(*exact)[k].weight);
    }
    if (has_normal(point)) {
      const Exact own(point.normal_sigma_rad);
      const Exact turn =
          inner(left(there.foot.first), there.foot.second) / (there.speed * there.slope);
      set(own * own + turn * turn * variance_along(left(n)), &(*exact)[k].normal_weight);
    }
  }
  return change;
}

}  // namespace

std::string_view name_of(GivenStatus status) {
  switch (status) {
    case GivenStatus::Fitted:
      return "fitted";
    case GivenStatus::NotFinite:
      return "not finite";
    case GivenStatus::TooFewPoints:
      return "too few points";
    case GivenStatus::Collinear:
      return "collinear";
    case GivenStatus::AtLimit:
      return "at limit";
    case GivenStatus::NotDetermined:
      return "not determined";
  }
  return "";
}

GivenFit fit_given_class(CurveClass curve_class, std::span<const GivenPoint> points,
                         const GivenOptions& options) {
  GivenFit fit;
  fit.shape.curve_class = curve_class;
  bool stated = true;
  for (const GivenPoint& point : points) {
    if (!is_sound(point)) {
      return fit;
    }
    stated = stated && (point.set_aside || noise_of(point, options.sigma_m) > 0.0);
  }
  fit.status = GivenStatus::TooFewPoints;
  // Stated and unstated noise do not mix: the data decide for all.
  const auto local = local_points(points, options.sigma_m, stated);
  if (!local || curve_class == CurveClass::Unclassified) {
    return fit;
  }
  fit.used = local->index.size();
  if (different(local->rough) + local->normals <
      static_cast<std::size_t>(degrees_of_freedom(curve_class))) {
    return fit;
  }
  // Two touches with normals lie on one line and determine a circle.
  if (curve_class != CurveClass::Line && local->normals == 0 && on_one_line(*local)) {
    fit.status = GivenStatus::Collinear;
    return fit;
  }
  fit.status = GivenStatus::AtLimit;
  Candidate found = search_sides(curve_class, *local, points);
  if (!std::isfinite(found.cost)) {
    return fit;
  }
  if (curve_class == CurveClass::Line) {
    slide_to_mean(*local, &found.curve);
  }
  PlacedCurve<Exact> placed = exact_of(found.curve);
  std::vector<WeighedPoint<Exact>> exact = local->exact;
  for (WeighedPoint<Exact>& point : exact) {
    point.offset = Exact(static_cast<double>(found.side)) * point.offset;
  }
  // Quadratic: what moves residuals by 1e-17 is followed by nothing that a double can hold.
  constexpr DescentEffort kToRounding{40, 1e-17, 1e-6};
  const auto seat = [](PlacedCurve<Exact>* trial) { return curve_of(*trial).has_value(); };
  auto descent = descend(&placed, std::span<const WeighedPoint<Exact>>(exact), kToRounding, seat);
  if (stated) {
    // Each round leaves of the weights' error about the noise over the radius of curvature.
    constexpr int kMostRounds = 40;
    constexpr double kSame = 1e-14;
    for (int round = 0; round < kMostRounds; ++round) {
      if (weigh_at_feet(placed, *local, points, options.sigma_m, &exact) <= kSame) {
        break;
      }
      descent = descend(&placed, std::span<const WeighedPoint<Exact>>(exact), kToRounding, seat);
    }
  }
  if (!descent.settled && !found.settled) {
    return fit;
  }
  fit.status = GivenStatus::Fitted;
  fit.side = found.side;
  fit.stationarity = stationarity_of(descent.squares, *local,
                                     static_cast<std::size_t>(Unknowns(curve_class).count));
  report_curve(placed, descent.squares, *local, &fit);
  report_residuals(&placed, *local, points, &fit);
  report_noise(points, *local, stated, options.sigma_m, 2.0 * to_double(descent.squares.cost),
               &fit);
  settle_pose(points, *local, &fit);
  return fit;
}

}  // namespace palpate
