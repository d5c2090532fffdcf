#include "core/recognition/given/local_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/recognition/samples/step_ratio.h"
#include "core/recognition/samples/stroke_order.h"

namespace palpate {
namespace {

/// Sets the strokes of the points in use, where they show their order.
void number_strokes(std::span<const GivenPoint> points, LocalPoints* local) {
  const std::vector<std::size_t>& index = local->index;
  for (std::size_t begin = 0; begin < index.size();) {
    const std::size_t stroke = points[index[begin]].stroke;
    std::size_t end = begin + 1;
    while (end < index.size() && points[index[end]].stroke == stroke) {
      ++end;
    }
    if (stroke != 0 && end - begin >= kFewestInOrder &&
        show_order(std::span(local->rough).subspan(begin, end - begin))) {
      for (std::size_t i = begin; i < end; ++i) {
        local->exact[i].stroke = stroke;
      }
    }
    begin = end;
  }
}

}  // namespace

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
  constexpr double kRoundings = 4.0;  // a few half units in the last place add up in a residual
  local.rounding = kRoundings * std::numeric_limits<double>::epsilon() *
                   low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff() / local.unit_m;
  const DoubleDouble inverse_unit(1.0 / local.unit_m);
  for (const std::size_t i : local.index) {
    const GivenPoint& point = points[i];
    WeighedPoint<DoubleDouble> exact;
    exact.position.x =
        inverse_unit * (DoubleDouble(point.position_m.x()) - DoubleDouble(local.middle_m.x()));
    exact.position.y =
        inverse_unit * (DoubleDouble(point.position_m.y()) - DoubleDouble(local.middle_m.y()));
    exact.weight = weighted ? DoubleDouble(local.unit_m) / DoubleDouble(noise_of(point, sigma_m))
                            : DoubleDouble(1.0);
    exact.stated = weighted;
    exact.offset = inverse_unit * DoubleDouble(point.tip_radius_m);
    if (weighted && has_normal(point)) {
      const Vec2 normal = point.normal.normalized();
      exact.normal = {DoubleDouble(normal.x()), DoubleDouble(normal.y())};
      exact.normal_weight = DoubleDouble(1.0) / DoubleDouble(point.normal_sigma_rad);
      ++local.normals;
    }
    local.exact.push_back(exact);
    local.rough.emplace_back(to_double(exact.position.x), to_double(exact.position.y));
  }
  number_strokes(points, &local);
  return local;
}

std::size_t different(std::vector<Vec2> points) {
  const auto less = [](const Vec2& u, const Vec2& v) {
    return u.x() < v.x() || (u.x() == v.x() && u.y() < v.y());
  };
  std::sort(points.begin(), points.end(), less);
  return static_cast<std::size_t>(std::unique(points.begin(), points.end()) - points.begin());
}

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

}  // namespace palpate
