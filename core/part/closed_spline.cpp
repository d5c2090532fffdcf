#include "core/part/closed_spline.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/curves/arc_length.h"
#include "core/curves/foot_point.h"
#include "core/numerics/polynomials/real_roots.h"

namespace palpate {

ClosedSpline::ClosedSpline(std::vector<Vec2> control_points) {
  const std::size_t n = control_points.size();
  assert(n >= kFewestPoints);
  segments_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2& p0 = control_points[i];
    const Vec2& p1 = control_points[(i + 1) % n];
    const Vec2& p2 = control_points[(i + 2) % n];
    const Vec2& p3 = control_points[(i + 3) % n];
    segments_[i].coefficients << (p0 + 4.0 * p1 + p2) / 6.0, (p2 - p0) / 2.0,
        (p0 - 2.0 * p1 + p2) / 2.0, (p3 - p0 + 3.0 * (p1 - p2)) / 6.0;
  }
}

ClosedSpline::Place ClosedSpline::place_at(double t) const {
  const auto count = static_cast<double>(size());
  double within = t - count * std::floor(t / count);
  // Rounding can make it equal to the count: that is the start of the first segment.
  within = within < count ? within : 0.0;
  const double segment = std::floor(within);
  return {static_cast<std::size_t>(segment), within - segment};
}

Vec2 ClosedSpline::position(double t) const {
  const Place place = place_at(t);
  return segments_[place.segment].position(place.u);
}

CurveDerivatives ClosedSpline::derivatives(double t) const {
  const Place place = place_at(t);
  return segments_[place.segment].derivatives(place.u);
}

ParameterDomain ClosedSpline::domain() const {
  const auto count = static_cast<double>(size());
  return {0.0, count, count};
}

FootPoint ClosedSpline::foot_point(const Vec2& point) const {
  if (!point.allFinite()) {
    return no_foot_point(*this);
  }
  FootPoint foot = nearest_foot_point(*this, point, [&](const auto& visit) {
    for (std::size_t i = 0; i < size(); ++i) {
      const auto start = static_cast<double>(i);
      visit(start);
      // (C(u) - p) . C'(u) as a polynomial in u.
      PolynomialCurve2::Coefficients c = segments_[i].coefficients;
      c.col(0) -= point;
      Polynomial<5> slope = Polynomial<5>::Zero();
      for (int j = 0; j <= 3; ++j) {
        for (int k = 1; k <= 3; ++k) {
          slope[j + k - 1] += k * c.col(j).dot(c.col(k));
        }
      }
      visit_real_roots<5>(slope, [&](double u) {
        if (u > 0.0 && u < 1.0) {
          visit(start + u);
        }
      });
    }
  });
  // The last Newton steps may cross the seam.
  const Place place = place_at(foot.t);
  foot.t = static_cast<double>(place.segment) + place.u;
  return foot;
}

double ClosedSpline::arc_length(double t0, double t1) const {
  if (t1 < t0) {
    return -arc_length(t1, t0);
  }
  double sum = 0.0;
  for (double from = t0; from < t1;) {  // the speed is smooth only between joints
    const double start = std::floor(from);
    const double to = std::min(start + 1.0, t1);
    const PolynomialCurve2& cubic = segments_[segment_at(start)];
    const auto speed = [&](double u) { return cubic.derivatives(u).first.norm(); };
    const auto& c = cubic.coefficients;
    const double terms = c.col(1).norm() + 2.0 * c.col(2).norm() + 3.0 * c.col(3).norm();
    sum += integrate_speed(speed, from - start, to - start, rounding_of_terms(terms));
    from = to;
  }
  return sum;
}

double ClosedSpline::parameter_at_arc_length(double t0, double s) const {
  const auto speed = [&](double t) { return derivatives(t).first.norm(); };
  return invert_arc_length([&](double from, double to) { return arc_length(from, to); }, speed, t0,
                           s, std::abs(s) / speed(t0));
}

ClosedSpline ClosedSpline::scaled(double factor) const {
  ClosedSpline result = *this;
  for (PolynomialCurve2& cubic : result.segments_) {
    cubic.coefficients *= factor;
  }
  return result;
}

double ClosedSpline::signed_area() const {
  // Half the integral of C x C' du, exactly.
  double twice = 0.0;
  for (const PolynomialCurve2& cubic : segments_) {
    const auto& c = cubic.coefficients;
    for (int j = 0; j <= 3; ++j) {
      for (int k = 1; k <= 3; ++k) {
        twice += k * cross(c.col(j), c.col(k)) / (j + k);
      }
    }
  }
  return 0.5 * twice;
}

std::optional<ClosedSpline::Canonical> ClosedSpline::canonical_segment(std::size_t i) const {
  const CubicCanonicalisation canonical = canonicalise(segment(i));
  if (!canonical.curve || canonical.curve->curve_class != CurveClass::CubicSpline) {
    return std::nullopt;
  }
  return Canonical{CubicSpline::from_parameters(canonical.curve->values),
                   canonical.curve->world_T_curve, canonical.curve->canonical_t};
}

}  // namespace palpate
