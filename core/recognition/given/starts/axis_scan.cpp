#include "core/recognition/given/starts/axis_scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/recognition/given/starts/axis_directions.h"
#include "core/recognition/given/starts/thinned.h"

namespace palpate {
namespace {

/// Enough points to see the valleys; the descent from a start takes all.
constexpr std::size_t kMostScanned = 32;

constexpr std::size_t kMostColumns = 4;

/// Powers of s, besides 1, of which the coordinate across the axis is a sum.
struct Columns {
  std::array<int, kMostColumns - 1> powers{};
  std::size_t count = 0;
  bool arm = false;  ///< s is the root of the distance from the vertex; else that along the axis
};

Columns columns_of(CurveClass curve_class) {
  switch (curve_class) {
    case CurveClass::Parabola:
      return {{1, 2, 0}, 2, false};
    case CurveClass::CubicalParabola:
      return {{1, 2, 3}, 3, false};
    case CurveClass::SemiCubicalParabola:
      return {{2, 3, 0}, 2, true};
    case CurveClass::CubicSpline:
      return {{1, 2, 3}, 3, true};
    default:
      return {};
  }
}

/// A graph across an axis: v = sum of coefficient * s^power.
struct Graph {
  double angle = 0.0;                   ///< of the axis
  double vertex = 0.0;                  ///< along the axis; 0 if the class has no arms
  std::array<double, 4> coefficient{};  ///< by power
  double cost = std::numeric_limits<double>::infinity();  ///< about the squared distances
};

class Scan {
 public:
  Scan(CurveClass curve_class, std::vector<Vec2> points)
      : columns_(columns_of(curve_class)), points_(std::move(points)) {
    s_.resize(points_.size());
    v_.resize(points_.size());
    weight_.resize(points_.size());
    for (std::vector<double>& column : column_) {
      column.resize(points_.size());
    }
  }

  /// All minima over the direction, `before` the first point along the axis by that distance.
  std::vector<Graph> minima(double before) {
    constexpr int kSections = 16;  // each leaves 0.618 of the bracket: to 1e-4 of two directions
    const double turn = columns_.arm ? 2.0 * kPi : kPi;
    const std::vector<double> angles = axis_directions(points_, turn);
    const int count = static_cast<int>(angles.size());
    std::vector<double> cost;
    cost.reserve(angles.size());
    for (const double angle : angles) {
      cost.push_back(graph(angle, before).cost);
    }
    std::vector<Graph> found;
    for (int k = 0; k < count; ++k) {
      const auto at = [&](int i) { return cost[static_cast<std::size_t>((i + count) % count)]; };
      const auto angle_at = [&](int i) {
        const int turns = i < 0 ? -1 : i / count;
        return angles[static_cast<std::size_t>((i + count) % count)] + turns * turn;
      };
      if (at(k) > at(k - 1) || !(at(k) < at(k + 1))) {
        continue;
      }
      constexpr double kGolden = 0.6180339887498949;
      double low = angle_at(k - 1);
      double high = angle_at(k + 1);
      Graph left = graph(high - kGolden * (high - low), before);
      Graph right = graph(low + kGolden * (high - low), before);
      for (int i = 0; i < kSections; ++i) {
        if (left.cost < right.cost) {
          high = right.angle;
          right = left;
          left = graph(high - kGolden * (high - low), before);
        } else {
          low = left.angle;
          left = right;
          right = graph(low + kGolden * (high - low), before);
        }
      }
      const Graph& best = left.cost < right.cost ? left : right;
      if (std::isfinite(best.cost)) {
        found.push_back(best);
      }
    }
    return found;
  }

  /// Unit normals of the graph at the points, left of increasing t.
  std::vector<Vec2> normals_of(const Graph& g) const {
    const Vec2 axis(std::cos(g.angle), std::sin(g.angle));
    std::vector<Vec2> normals;
    for (const Vec2& point : points_) {
      const double u = axis.dot(point);
      const double s = columns_.arm ? std::sqrt(std::max(0.0, u - g.vertex)) : u;
      const double along = columns_.arm ? 2.0 * s : 1.0;
      const Vec2 tangent = along * axis + slope_of(g, s) * left_of(axis);
      normals.push_back(direction_of(g) * left_of(tangent).normalized());
    }
    return normals;
  }

  /// Whether t increases with the coordinate along the axis.
  double direction_of(const Graph& g) const {
    if (columns_.count == 2 && !columns_.arm) {
      return g.coefficient[2] > 0.0 ? -1.0 : 1.0;
    }
    return columns_.arm && g.coefficient[3] < 0.0 ? -1.0 : 1.0;
  }

 private:
  static double slope_of(const Graph& g, double s) {
    return g.coefficient[1] + s * (2.0 * g.coefficient[2] + 3.0 * g.coefficient[3] * s);
  }

  /// Least squares across the axis, then once more with weights that make it orthogonal distances.
  Graph graph(double angle, double before) {
    Graph g;
    g.angle = angle;
    const Vec2 axis(std::cos(angle), std::sin(angle));
    double first = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      s_[i] = axis.dot(points_[i]);
      v_[i] = cross(axis, points_[i]);
      first = std::min(first, s_[i]);
    }
    if (columns_.arm) {
      g.vertex = first - before;
      for (double& s : s_) {
        s = std::sqrt(s - g.vertex);
      }
    }
    std::fill(weight_.begin(), weight_.end(), 1.0);
    solve(&g);
    for (std::size_t i = 0; i < s_.size(); ++i) {
      const double s = s_[i];
      const double by_s = slope_of(g, s);
      const double along = columns_.arm ? 2.0 * s : 1.0;
      // |C'| of (s^2, v) or of (s, v): the distance is the miss across times along / |C'|.
      const double speed = std::hypot(along, by_s);
      weight_[i] = speed > 0.0 ? along / speed : 1.0;
    }
    solve(&g);
    return g;
  }

  /// Modified Gram-Schmidt: columns of a vertex far away are nearly one another's multiples.
  void solve(Graph* g) {
    const std::size_t count = columns_.count + 1;
    std::array<std::array<double, kMostColumns>, kMostColumns> r{};
    std::array<double, kMostColumns> right{};
    for (std::size_t i = 0; i < s_.size(); ++i) {
      const double s = s_[i];
      column_[0][i] = weight_[i];
      for (std::size_t j = 1; j < count; ++j) {
        const int power = columns_.powers[j - 1];
        column_[j][i] = weight_[i] * (power == 1 ? s : power == 2 ? s * s : s * s * s);
      }
      miss_.resize(s_.size());
      miss_[i] = weight_[i] * v_[i];
    }
    const auto product = [&](const std::vector<double>& u, const std::vector<double>& w) {
      double sum = 0.0;
      for (std::size_t i = 0; i < u.size(); ++i) {
        sum += u[i] * w[i];
      }
      return sum;
    };
    const auto remove = [&](const std::vector<double>& unit, double by, std::vector<double>* u) {
      for (std::size_t i = 0; i < u->size(); ++i) {
        (*u)[i] -= by * unit[i];
      }
    };
    for (std::size_t j = 0; j < count; ++j) {
      r[j][j] = std::sqrt(product(column_[j], column_[j]));
      if (!(r[j][j] > 0.0)) {
        g->cost = std::numeric_limits<double>::infinity();
        return;
      }
      for (double& value : column_[j]) {
        value /= r[j][j];
      }
      for (std::size_t k = j + 1; k < count; ++k) {
        r[j][k] = product(column_[j], column_[k]);
        remove(column_[j], r[j][k], &column_[k]);
      }
      right[j] = product(column_[j], miss_);
      remove(column_[j], right[j], &miss_);
    }
    g->cost = product(miss_, miss_);
    g->coefficient = {};
    for (std::size_t j = count; j-- > 0;) {
      double value = right[j];
      for (std::size_t k = j + 1; k < count; ++k) {
        const int power = columns_.powers[k - 1];
        value -= r[j][k] * g->coefficient[static_cast<std::size_t>(power)];
      }
      const int power = j == 0 ? 0 : columns_.powers[j - 1];
      g->coefficient[static_cast<std::size_t>(power)] = value / r[j][j];
    }
  }

  Columns columns_;
  std::vector<Vec2> points_;
  std::vector<double> s_;
  std::vector<double> v_;
  std::vector<double> weight_;
  std::vector<double> miss_;
  std::array<std::vector<double>, kMostColumns> column_;
};

GivenStart start_of(CurveClass curve_class, const Graph& g) {
  const auto [c0, c1, c2, c3] = g.coefficient;
  GivenStart start;
  start.shape.curve_class = curve_class;
  start.shape.values.setZero();
  const Vec2 axis(std::cos(g.angle), std::sin(g.angle));
  Vec2 origin = g.vertex * axis + c0 * left_of(axis);
  start.pose.theta = g.angle;
  switch (curve_class) {
    case CurveClass::Parabola: {
      // v = c0 + c1 u + c2 u^2 opens along v, to the side of c2.
      const double u = -0.5 * c1 / c2;
      origin = u * axis + (c0 + 0.5 * c1 * u) * left_of(axis);
      start.shape.values[0] = 0.25 / std::abs(c2);
      start.pose.theta += std::copysign(0.5 * kPi, c2);
      break;
    }
    case CurveClass::CubicalParabola: {
      // About the inflection, v = v0 + slope u + c3 u^3.
      const double u = -c2 / (3.0 * c3);
      origin = u * axis + (c0 + u * (c1 + u * (c2 + u * c3))) * left_of(axis);
      start.shape.values[0] = c3;
      start.shape.values[1] = c1 + u * (2.0 * c2 + 3.0 * c3 * u);
      break;
    }
    default:
      // t = s on the arm where the cubic rises, else -s: a > 0.
      start.arm = c3 > 0.0 ? 1 : -1;
      start.shape.values[0] = std::abs(c3);
      start.shape.values[1] = c2;
      if (curve_class == CurveClass::CubicSpline) {
        start.shape.values[2] = std::copysign(1.0, c3) * c1;
      }
      break;
  }
  start.pose.x = origin.x();
  start.pose.y = origin.y();
  return start;
}

/// Vertices before the points, in about half extents of these. From the nearest, s of the first
/// point is some 26th of the last one's, and from one to the next it grows by the root of kRatio,
/// 18 %: a valley follows. From the farthest (9.6), an arm of a semi-cubical parabola that bulges
/// by a half extent is a parabola, of an axis of its own, to a ten-thousandth of that.
std::vector<double> places_of_vertex(bool arm) {
  if (!arm) {
    return {0.0};
  }
  constexpr double kNearest = 0.003;
  constexpr double kFarthest = 12.0;
  constexpr double kRatio = 1.4;
  std::vector<double> before;
  for (double place = kNearest; place < kFarthest; place *= kRatio) {
    before.push_back(place);
  }
  return before;
}

/// The minima over direction and vertex, the lower ones first.
std::vector<Graph> lowest_graphs(Scan* scan, bool arm) {
  // Along a valley the axis turns less than this from one vertex to the next.
  constexpr double kOneValley = kPi / 18.0;
  std::vector<std::vector<Graph>> rows;
  for (const double before : places_of_vertex(arm)) {
    rows.push_back(scan->minima(before));
  }
  const auto is_lower_beside = [&](std::size_t row, const Graph& g) {
    return row < rows.size() &&
           std::any_of(rows[row].begin(), rows[row].end(), [&](const Graph& o) {
             return o.cost < g.cost &&
                    std::abs(std::remainder(o.angle - g.angle, 2.0 * kPi)) < kOneValley;
           });
  };
  std::vector<Graph> lowest;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (const Graph& g : rows[row]) {
      if (!(row > 0 && is_lower_beside(row - 1, g)) && !is_lower_beside(row + 1, g)) {
        lowest.push_back(g);
      }
    }
  }
  std::stable_sort(lowest.begin(), lowest.end(),
                   [](const Graph& u, const Graph& v) { return u.cost < v.cost; });
  return lowest;
}

}  // namespace

std::vector<GivenStart> starts_by_axis(CurveClass curve_class, std::span<const Vec2> points,
                                       std::span<const double> radii) {
  constexpr std::size_t kMostStarts = 12;  // of points on one surface
  const Columns columns = columns_of(curve_class);
  std::vector<GivenStart> starts;
  if (columns.count == 0) {
    return starts;
  }
  const std::vector<Vec2> centres = thinned(points, kMostScanned);
  const std::vector<double> taken_off = thinned(radii, kMostScanned);
  const auto add = [&](const Scan& scan, std::span<const Graph> graphs, std::span<const Vec2> out) {
    for (std::size_t i = 0; i < std::min(graphs.size(), kMostStarts); ++i) {
      GivenStart start = start_of(curve_class, graphs[i]);
      if (!out.empty()) {
        const std::vector<Vec2> normals = scan.normals_of(graphs[i]);
        double along = 0.0;
        for (std::size_t k = 0; k < out.size(); ++k) {
          along += normals[k].dot(out[k]);
        }
        start.side = along > 0.0 ? 1 : -1;
      }
      if (start.shape.values.allFinite() && std::isfinite(start.pose.x + start.pose.y)) {
        starts.push_back(start);
      }
    }
  };
  Scan scan(curve_class, centres);
  const std::vector<Graph> graphs = lowest_graphs(&scan, columns.arm);
  const bool tips =
      std::any_of(taken_off.begin(), taken_off.end(), [](double radius) { return radius > 0.0; });
  if (!tips || graphs.empty()) {
    add(scan, graphs, {});
    return starts;
  }
  for (const double side : {1.0, -1.0}) {
    std::vector<Vec2> out = scan.normals_of(graphs.front());
    std::vector<Vec2> touched = centres;
    for (std::size_t k = 0; k < touched.size(); ++k) {
      out[k] *= side;
      touched[k] -= taken_off[k] * out[k];
    }
    Scan of_surface(curve_class, touched);
    add(of_surface, lowest_graphs(&of_surface, columns.arm), out);
  }
  return starts;
}

}  // namespace palpate
