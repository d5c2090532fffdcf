#include "core/recognition/given/all_starts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/curves/cubic_spline.h"
#include "core/recognition/given/starts/axis_scan.h"

namespace palpate {
namespace {

/// Appends the best spline with its bend at t = 0 no sharper than a circle of that radius, as tip
/// centres go about a corner. Where none of them lies on that bend, splines through them are cusps.
void add_rounded(double radius, std::vector<GivenStart>* starts) {
  const double least = CubicSpline::c_of_bend(radius);
  if (!starts->empty() && starts->front().shape.values[2] < least) {
    starts->push_back(starts->front());
    starts->back().shape.values[2] = least;
  }
}

/// Hyperbolas that bend at their vertex as the parabolas do. Of a short arc, the conics of least
/// algebraic distance may all be ellipses, but for a pair of lines.
std::vector<GivenStart> beside_parabolas(std::span<const GivenStart> parabolas) {
  // In half extents of the points: over these, the nearer one turns towards its asymptotes, and the
  // farther one is a parabola to some hundredths.
  constexpr std::array kHalfAxes{1.0, 8.0};
  std::vector<GivenStart> hyperbolas;
  for (const GivenStart& parabola : parabolas) {
    for (const double a : kHalfAxes) {
      // Beside the vertex y^2 = 2 b^2 (x - a) / a, of a parabola 4 (its a) x.
      GivenStart hyperbola = parabola;
      hyperbola.shape.curve_class = CurveClass::Hyperbola;
      hyperbola.shape.values = {a, std::sqrt(2.0 * a * parabola.shape.values[0]), 0.0};
      hyperbola.pose.x -= a * std::cos(parabola.pose.theta);
      hyperbola.pose.y -= a * std::sin(parabola.pose.theta);
      hyperbolas.push_back(hyperbola);
    }
  }
  return hyperbolas;
}

}  // namespace

std::vector<GivenStart> starts_of(CurveClass curve_class, const LocalPoints& local) {
  std::vector<GivenStart> starts = given_starts(curve_class, local.rough);
  std::vector<double> radii;
  for (const WeighedPoint<DoubleDouble>& point : local.exact) {
    radii.push_back(to_double(point.offset));
  }
  if (curve_class == CurveClass::CubicSpline) {
    add_rounded(*std::max_element(radii.begin(), radii.end()), &starts);
  }
  const std::vector<GivenStart> by_axis =
      curve_class == CurveClass::Hyperbola
          ? beside_parabolas(starts_by_axis(CurveClass::Parabola, local.rough, radii))
          : starts_by_axis(curve_class, local.rough, radii);
  starts.insert(starts.end(), by_axis.begin(), by_axis.end());
  // Twice as many points as the most unknowns: then the scan needs no normals.
  constexpr std::size_t kEnough = 2 * kMostUnknowns;
  if (local.normals == 0 || (!by_axis.empty() && local.rough.size() >= kEnough)) {
    return starts;
  }
  // Of the points' extent, which is about 1. So near, a curve has hardly left its tangent.
  constexpr double kAside = 0.1;
  std::vector<Vec2> more = local.rough;
  for (const WeighedPoint<DoubleDouble>& point : local.exact) {
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

}  // namespace palpate
