#include "core/recognition/posterior/edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "core/numerics/levenberg_marquardt.h"
#include "core/numerics/matrices/small_cholesky.h"
#include "core/recognition/fit/class_fits.h"
#include "core/recognition/fit/starts/algebraic_fit.h"

namespace palpate {
namespace {

using Vector = Eigen::Matrix<double, kEdgesCoordinates, 1>;
using Matrix = Eigen::Matrix<double, kEdgesCoordinates, kEdgesCoordinates>;

/// Radii of fillets are alike probable by their logarithm, from where no stroke shows them to where
/// no edge is left. In half extents.
constexpr double kLeastRadius = 1.0 / 1024.0;
constexpr double kLargestRadius = 4.0;

/// Centre, bisector, half turn and log radius: the radius is positive.
RoundedCorner corner_of(const Vector& x) { return {x.head<2>(), x[2], x[3], std::exp(x[4])}; }

/// +1 and -1: on which side of the bisector a point lies.
using Sides = std::vector<double>;

/// Distances from the curve of a corner, for `minimise`: of each point from the nearest place, or
/// from the edge on its side and the arc.
class EdgesProblem {
 public:
  static constexpr int kParameters = kEdgesCoordinates;

  explicit EdgesProblem(std::span<const FitPoint> points) : points_(points) {}
  EdgesProblem(std::span<const FitPoint> points, const Sides& sides)
      : points_(points), sides_(sides) {}

  double chi2_at(const Vector& x) {
    tried_ = x;
    if (!(x[3] > 0.0 && x[3] <= 0.5 * std::numbers::pi)) {
      return std::numeric_limits<double>::infinity();
    }
    const RoundedCornerAxes corner(corner_of(x));
    double chi2 = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const FitPoint& point = points_[i];
      const double residual =
          point.inverse_sigma * corner.distance(point.position, side_of(corner, i));
      chi2 += residual * residual;
    }
    return chi2;
  }

  void accept() { at_ = tried_; }

  std::size_t points() const { return points_.size(); }

  void linearise(Matrix* information, Vector* gradient) const {
    information->setZero();
    gradient->setZero();
    const double radius = corner_of(at_).radius;
    const RoundedCornerAxes corner(corner_of(at_));
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const FitPoint& point = points_[i];
      const RoundedCorner::Distance distance =
          corner.with_gradient(point.position, side_of(corner, i));
      Vector row = point.inverse_sigma * distance.gradient.transpose();
      row[4] *= radius;
      *information += row * row.transpose();
      *gradient += point.inverse_sigma * distance.value * row;
    }
  }

 private:
  double side_of(const RoundedCornerAxes& corner, std::size_t i) const {
    return sides_.empty() ? corner.side_of(points_[i].position) : sides_[i];
  }

  std::span<const FitPoint> points_;
  std::span<const double> sides_;
  Vector tried_ = Vector::Zero();
  Vector at_ = Vector::Zero();
};

/// A straight edge.
struct Edge {
  Vec2 place = Vec2::Zero();
  Vec2 along = Vec2::UnitX();

  double distance(const Vec2& point) const { return std::abs(cross(along, point - place)); }
};

/// The two edges, along the strokes at two of their points, that all points are next to.
std::optional<std::array<Edge, 2>> seen_edges(std::span<const FitPoint> points, WorkBudget& work) {
  constexpr std::size_t kTried = 12;   // points: of 66 pairs one has both edges, if seen
  constexpr double kLeastTurn = 0.02;  // sine; a flatter corner bends like a class
  std::vector<Edge> edges;
  const std::size_t step = std::max<std::size_t>(points.size() / kTried, 1);
  for (std::size_t i = step / 2; i < points.size(); i += step) {
    if (!points[i].tangent.isZero(0.0)) {
      edges.push_back({points[i].position, points[i].tangent});
    }
  }
  std::vector<double> distances(edges.size() * points.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      distances[e * points.size() + i] =
          points[i].inverse_sigma * edges[e].distance(points[i].position);
    }
  }
  std::optional<std::array<Edge, 2>> best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    for (std::size_t f = 0; f < e; ++f) {
      if (std::abs(cross(edges[e].along, edges[f].along)) < kLeastTurn) {
        continue;
      }
      // Not their squares: those of points on the arc would decide.
      double sum = 0.0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        sum += std::min(distances[e * points.size() + i], distances[f * points.size() + i]);
      }
      if (sum < least) {
        least = sum;
        best = {edges[e], edges[f]};
      }
    }
  }
  work.spend(WorkKind::SeedRow, edges.size() * edges.size() / 2 * points.size());
  return best;
}

/// The corner of two edges, sharp so far: where they meet, and the directions of their normals on
/// the outside.
struct SharpCorner {
  Vec2 place = Vec2::Zero();
  Vec2 first = Vec2::UnitX();
  Vec2 second = Vec2::UnitX();

  Vector rounded(double radius) const {
    const Vec2 ahead = first + second;
    Vector x;
    x << place - radius / (1.0 + first.dot(second)) * ahead, std::atan2(ahead.y(), ahead.x()),
        0.5 * std::abs(turn_between(first, second)), std::log(radius);
    return x;
  }
};

SharpCorner corner_between(const std::array<Edge, 2>& edges, std::span<const FitPoint> points) {
  SharpCorner corner;
  const double turn = cross(edges[0].along, edges[1].along);
  const double s = cross(edges[1].place - edges[0].place, edges[1].along) / turn;
  corner.place = edges[0].place + s * edges[0].along;
  std::array<double, 2> way{};  // from the corner, along each edge, of the points next to it
  for (const FitPoint& point : points) {
    const bool second = edges[1].distance(point.position) < edges[0].distance(point.position);
    way[second ? 1 : 0] += edges[second ? 1 : 0].along.dot(point.position - corner.place);
  }
  const Vec2 arm = way[0] < 0.0 ? Vec2(-edges[0].along) : edges[0].along;
  const Vec2 other = way[1] < 0.0 ? Vec2(-edges[1].along) : edges[1].along;
  corner.first = (arm.dot(other) * arm - other).normalized();
  corner.second = (arm.dot(other) * other - arm).normalized();
  return corner;
}

constexpr double kAnyChi2 = std::numeric_limits<double>::infinity();

/// The optimum from `x`, in so many steps.
MinimiseSummary refine(EdgesProblem* problem, int steps, double out_of_reach, Vector* x,
                       WorkBudget& work) {
  constexpr double kTolerance = 1e-2;  // of chi-square; evidence is asked for to a tenth
  MinimiseOptions options{steps, kTolerance};
  options.out_of_reach = out_of_reach;
  options.work = &work;
  options.row = WorkKind::AxisRow;
  options.rows = problem->points();
  return minimise(problem, x, options);
}

/// Of corners with these edges, the one that is nearest to the points: its radius to a `factor`.
Vector with_best_radius(const SharpCorner& corner, double factor, EdgesProblem* problem,
                        WorkBudget& work) {
  constexpr std::size_t kDistancesOfRow = 4;  // that take the time of one
  Vector best = Vector::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (double radius = kLeastRadius; radius <= kLargestRadius; radius *= factor) {
    const Vector x = corner.rounded(radius);
    const double chi2 = problem->chi2_at(x);
    work.spend(WorkKind::SeedRow, problem->points() / kDistancesOfRow);
    if (chi2 < least) {
      least = chi2;
      best = x;
    }
  }
  return best;
}

/// The edges of a rounded corner.
SharpCorner sharp(const Vector& x) {
  const RoundedCorner corner = corner_of(x);
  const Vec2 ahead(std::cos(corner.bisector), std::sin(corner.bisector));
  const Vec2 across = std::sin(corner.half_turn) * left_of(ahead);
  const double cosine = std::cos(corner.half_turn);
  return {corner.centre + corner.radius / cosine * ahead, cosine * ahead - across,
          cosine * ahead + across};
}

/// Whether one edge, or its arc, is all that the points show.
bool are_line_or_circle(std::span<const FitPoint> points, WorkBudget& work) {
  work.spend(WorkKind::ConicRow, 2 * points.size());
  const auto fits = [&](const ConicCoefficients& coefficients) {
    return fits_well(placed_on(points, ImplicitFit{coefficients, 0.0, 0, {}}).chi2, points.size());
  };
  return fits(algebraic_line(points)) || fits(algebraic_circle(points));
}

/// The sides of the points where a probe goes from the one edge to the other once along each patch,
/// or along one of them alone: those that leave the least.
Sides in_order(const RoundedCorner& corner, const FitData& data) {
  const RoundedCornerAxes axes(corner);
  Sides sides(data.points.size());
  for (const PatchSpan& patch : data.patches) {
    // What the points before one leave on either side over what they leave on the other.
    double more_on_second = 0.0;
    double least = 0.0;
    double most = 0.0;
    std::size_t at_least = patch.begin;
    std::size_t at_most = patch.begin;
    for (std::size_t i = patch.begin; i < patch.end; ++i) {
      const FitPoint& point = data.points[i];
      const double first = point.inverse_sigma * axes.distance(point.position, -1.0);
      const double second = point.inverse_sigma * axes.distance(point.position, 1.0);
      more_on_second += second * second - first * first;
      if (more_on_second < least) {
        least = more_on_second;
        at_least = i + 1;
      }
      if (more_on_second > most) {
        most = more_on_second;
        at_most = i + 1;
      }
    }
    // On the second edge before and on the first after, or the other way.
    const bool second_first = least < more_on_second - most;
    const std::size_t change = second_first ? at_least : at_most;
    for (std::size_t i = patch.begin; i < patch.end; ++i) {
      sides[i] = (i < change) == second_first ? 1.0 : -1.0;
    }
  }
  return sides;
}

bool are_of_one_tip(std::span<const FitPoint> points) {
  return std::all_of(points.begin(), points.end(),
                     [&](const FitPoint& point) { return point.offset == points.front().offset; });
}

}  // namespace

std::optional<Edges> edges_of(const Arcs& arcs, double out_of_reach, WorkBudget& work) {
  const std::span<const FitPoint> points(arcs.data.points);
  const std::span<const FitPoint> reduced(arcs.smooth.reduced.points);
  if (residual_count(arcs.data) > points.size() || !are_of_one_tip(points) || !work.allows()) {
    return std::nullopt;
  }
  const auto seen = are_line_or_circle(reduced, work) ? std::nullopt : seen_edges(reduced, work);
  if (!seen) {
    return std::nullopt;
  }
  EdgesProblem on_reduced(reduced);
  constexpr double kRoughly = 2.0;
  Vector x = with_best_radius(corner_between(*seen, reduced), kRoughly, &on_reduced, work);
  // The directions of the edges are those of the strokes at one point each. The first steps set
  // them right, and tell which points lie on the arc: before, no linear model holds.
  constexpr int kFirstSteps = 4;
  constexpr int kSteps = 20;
  refine(&on_reduced, kFirstSteps, kAnyChi2, &x, work);
  // Beside edges that are right, the radius: where it leaves no point on the arc, or all, no step
  // leads to it.
  constexpr double kClosely = 1.19;  // 2^(1/4): nearer than any of these, the steps converge
  const Vector other = with_best_radius(sharp(x), kClosely, &on_reduced, work);
  if (on_reduced.chi2_at(other) < on_reduced.chi2_at(x)) {
    x = other;
  }
  const MinimiseSummary coarse = refine(&on_reduced, kSteps, out_of_reach, &x, work);
  if (!(coarse.chi2 <= out_of_reach)) {
    return std::nullopt;
  }
  EdgesProblem on_all(points);
  work.spend(WorkKind::AxisRow, points.size());
  double chi2 = on_all.chi2_at(x);
  EdgesProblem* settled = &on_reduced;
  if (std::abs(chi2 - (arcs.smooth.chi2 + coarse.chi2)) > kLeastError) {
    // No section leads round a corner that is sharper than it is long.
    chi2 = refine(&on_all, kSteps, kAnyChi2, &x, work).chi2;
    settled = &on_all;
  }
  // Where two edges lie within the noise of one another, the nearest of both leaves less than the
  // noise, whatever was touched.
  constexpr int kMostOrders = 4;
  Sides sides;
  EdgesProblem ordered(points, sides);
  for (int i = 0; i < kMostOrders && work.allows(); ++i) {
    sides = in_order(corner_of(x), arcs.data);
    ordered = EdgesProblem(points, sides);
    work.spend(WorkKind::AxisRow, 2 * points.size());
    if (std::abs(ordered.chi2_at(x) - chi2) <= kLeastError) {
      break;
    }
    chi2 = refine(&ordered, kSteps, kAnyChi2, &x, work).chi2;
    settled = &ordered;
  }
  settled->chi2_at(x);
  settled->accept();
  Edges edges{corner_of(x), chi2, {}};
  Vector gradient;
  settled->linearise(&edges.information, &gradient);
  return edges;
}

double log_occam_of(const Edges& edges, double inflation) {
  // Each coordinate by the width of the normal law that is as high as its prior. The place of the
  // corner across an edge as that of any class's; along it within the half extents.
  const double across = std::sqrt(0.5 * std::numbers::pi);
  const double along = 2.0 / std::sqrt(2.0 * std::numbers::pi);
  // The direction of an edge as that of any class; the turn to the other one, twice the half turn,
  // uniform to either side.
  const double turn = 0.5 * std::sqrt(2.0 * std::numbers::pi);
  const double radius = std::log(kLargestRadius / kLeastRadius) / std::sqrt(2.0 * std::numbers::pi);
  const double place = std::sqrt(across * along);
  const Vector widths = (Vector() << place, place, across, turn, radius).finished();
  Matrix relative = widths.asDiagonal() * edges.information * widths.asDiagonal() / inflation;
  relative.diagonal().array() += 1.0;
  Matrix lower;
  if (!cholesky(relative, &lower)) {
    return -std::numeric_limits<double>::infinity();
  }
  return -std::log(lower.diagonal().prod());
}

}  // namespace palpate
