#include "core/invariants/spline_pair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/curves/pose2.h"

namespace palpate {
namespace {

/// Distances u along the cubic, in units of the largest radius of curvature.
constexpr double kSmallestDistance = 1e-3;
constexpr double kLargestDistance = 1e3;
constexpr int kStepsPerSide = 60;  ///< ten per decade
/// A local minimum of the misfit below this (the misfit is 1 where nothing agrees) may hide two
/// roots within one step, a factor of 1.26 of u, or a root that noise has removed. It is offered
/// too; one too many only costs time.
constexpr double kNearRoot = 0.3;
/// The Illinois method has order 1.44: eight iterations improve an error of a tenth, that of a
/// step, to the last digit of a double.
constexpr int kRootIterations = 12;

/// A cubic by its hodograph alpha'(u) = (1 + p u + q u^2, kappa u + m u^2) at a base point.
struct BaseCubic {
  double p = 0.0;
  double q = 0.0;
  double kappa = 0.0;
  double m = 0.0;
};

/// The other point, relative to the tangent at the base point.
struct Other {
  double cosine;
  double sine;
  double kappa;
  double kappa_s;
};

Other seen_from(const MeasuredGeometry& base, const MeasuredGeometry& point) {
  const double rotation = point.tangent_angle - base.tangent_angle;
  return {std::cos(rotation), std::sin(rotation), point.kappa, point.kappa_s};
}

/// Speed v along the tangent of the other point, l = cross(tangent, alpha''), and the terms of
/// kappa_s. For either direction of travel, kappa = l / v^2 and kappa_s = (v c - 3 l d) / v^4.
struct AtOther {
  double v;
  double l;
  double c;
  double d;
};

AtOther at_other(const BaseCubic& cubic, const Other& other, double u) {
  const Vec2 first(1.0 + (cubic.p + cubic.q * u) * u, (cubic.kappa + cubic.m * u) * u);
  const Vec2 second(cubic.p + 2.0 * cubic.q * u, cubic.kappa + 2.0 * cubic.m * u);
  const Vec2 tangent(other.cosine, other.sine);
  return {tangent.dot(first), cross(tangent, second),
          cross(tangent, Vec2(2.0 * cubic.q, 2.0 * cubic.m)), tangent.dot(second)};
}

/// Left side minus right side of the equation for kappa_s, relative to its terms: in [-1, 1].
double kappa_s_misfit(const AtOther& at, double kappa_s) {
  const double v2 = at.v * at.v;
  const double left = kappa_s * v2 * v2;
  const double right1 = at.v * at.c;
  const double right2 = 3.0 * at.l * at.d;
  const double size = std::abs(left) + std::abs(right1) + std::abs(right2);
  return size > 0.0 ? (left - right1 + right2) / size : 0.0;
}

double kappa_misfit(const AtOther& at, double kappa) {
  const double left = kappa * at.v * at.v;
  const double size = std::abs(left) + std::abs(at.l);
  return size > 0.0 ? (left - at.l) / size : 0.0;
}

/// The cubic through base and other, with the other point at u. `branch` selects one of the two
/// roots of the equation for its kappa.
std::optional<BaseCubic> cubic_at(const MeasuredGeometry& base, const Other& other, double u,
                                  double branch) {
  const double u2 = u * u;
  const double m0 = 0.5 * base.kappa_s;
  const double m1 = 1.5 * base.kappa;
  // cross(alpha'(u), tangent) = 0 is by_p p + by_q q = rest: a line in (p, q), parametrised by s.
  const double by_p = u * other.sine - m1 * u2 * other.cosine;
  const double by_q = u2 * other.sine;
  const double rest = (base.kappa * u + m0 * u2) * other.cosine - other.sine;
  const double norm2 = by_p * by_p + by_q * by_q;
  if (!(norm2 > 0.0)) {
    return std::nullopt;
  }
  const double norm = std::sqrt(norm2);
  const Vec2 origin = Vec2(by_p, by_q) * (rest / norm2);
  const Vec2 along = Vec2(-by_q, by_p) / norm;
  const auto cubic_of = [&](double s) {
    const Vec2 pq = origin + s * along;
    return BaseCubic{pq.x(), pq.y(), base.kappa, m0 + m1 * pq.x()};
  };
  // v and l are linear in s: kappa v^2 = l is a quadratic.
  const AtOther at0 = at_other(cubic_of(0.0), other, u);
  const AtOther at1 = at_other(cubic_of(1.0), other, u);
  const double v1 = at1.v - at0.v;
  const double l1 = at1.l - at0.l;
  const double k2 = other.kappa * v1 * v1;
  const double k1 = 2.0 * other.kappa * at0.v * v1 - l1;
  const double k0 = other.kappa * at0.v * at0.v - at0.l;
  const double discriminant = k1 * k1 - 4.0 * k2 * k0;
  if (!(discriminant >= 0.0)) {
    return std::nullopt;
  }
  const double root = std::sqrt(discriminant);
  // The branch is the sign of the root. Each root is computed by the formula that does not cancel.
  const double s =
      branch * k1 > 0.0 ? -2.0 * k0 / (k1 + branch * root) : (-k1 + branch * root) / (2.0 * k2);
  return std::isfinite(s) ? std::optional(cubic_of(s)) : std::nullopt;
}

/// How badly the cubic misses another point: mean of the squared misfits of kappa and kappa_s, at
/// the better of the two places that have its tangent direction. In [0, 1].
double disagreement(const BaseCubic& cubic, const Other& other) {
  // cross(alpha'(u), tangent) = 0, a quadratic in u.
  const double k2 = cubic.q * other.sine - cubic.m * other.cosine;
  const double k1 = cubic.p * other.sine - cubic.kappa * other.cosine;
  const double k0 = other.sine;
  const double discriminant = k1 * k1 - 4.0 * k2 * k0;
  if (discriminant < 0.0) {
    return 1.0;
  }
  const double half = -0.5 * (k1 + std::copysign(std::sqrt(discriminant), k1));
  double best = 1.0;
  for (const double u : {half / k2, k0 / half}) {
    if (std::isfinite(u)) {
      const AtOther at = at_other(cubic, other, u);
      best = std::min(best, 0.5 * (std::pow(kappa_misfit(at, other.kappa), 2) +
                                   std::pow(kappa_s_misfit(at, other.kappa_s), 2)));
    }
  }
  return best;
}

/// Appendix B: the canonical form of the cubic; nullopt for a parabola or a cubical parabola.
std::optional<SplineSeed> canonical_seed(const BaseCubic& cubic, double base_angle) {
  const Vec2 third(cubic.q, cubic.m);
  const double size = third.norm();
  if (!(size > 0.0)) {
    return std::nullopt;
  }
  Vec2 y_axis = third / size;
  Vec2 x_axis(y_axis.y(), -y_axis.x());
  const Vec2 first(1.0, 0.0);
  const Vec2 second(cubic.p, cubic.kappa);
  if (x_axis.dot(second) < 0.0) {
    x_axis = -x_axis;
    y_axis = -y_axis;
  }
  const double x2 = x_axis.dot(second);
  const double rho = std::sqrt(0.5 * x2);  // t = rho (u + shift)
  const double shift = x_axis.dot(first) / x2;
  const double y3 = y_axis.dot(third);
  SplineSeed seed;
  seed.parameters = {y3 / (3.0 * rho * rho * rho),
                     (y_axis.dot(second) - 2.0 * y3 * shift) / (2.0 * rho * rho),
                     (y_axis.dot(first) + (y3 * shift - y_axis.dot(second)) * shift) / rho};
  if (seed.parameters[0] < 0.0) {  // t -> -t
    seed.parameters[0] *= -1.0;
    seed.parameters[2] *= -1.0;
  }
  seed.orientation = wrap_angle(base_angle + std::atan2(x_axis.y(), x_axis.x()));
  return seed.parameters.allFinite() ? std::optional(seed) : std::nullopt;
}

/// The distances to try on either side.
std::array<double, kStepsPerSide> distances() {
  std::array<double, kStepsPerSide> result;
  const double decades = std::log10(kLargestDistance / kSmallestDistance);
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] =
        kSmallestDistance * std::pow(10.0, decades * static_cast<double>(k) / (kStepsPerSide - 1));
  }
  return result;
}

class SeedSearch {
 public:
  SeedSearch(std::span<const MeasuredGeometry> points, int wanted)
      : points_(points), wanted_(static_cast<std::size_t>(wanted)), distances_(distances()) {}

  void search_pair(std::size_t base, std::size_t partner) {
    base_ = &points_[base];
    const Other other = seen_from(*base_, points_[partner]);
    for (const double side : {1.0, -1.0}) {  // forward and backward along the base's travel
      for (const double branch : {1.0, -1.0}) {
        std::optional<double> before;
        std::optional<double> previous;
        double u_before = 0.0;
        for (const double distance : distances_) {
          const double u = side * distance;
          const std::optional<double> misfit = misfit_at(other, u, branch);
          if (misfit && previous && *misfit * *previous <= 0.0) {
            offer(root(other, branch, u_before, *previous, u, *misfit), other, branch, partner);
          } else if (misfit && previous && before && std::abs(*previous) < kNearRoot &&
                     std::abs(*previous) < std::abs(*before) &&
                     std::abs(*previous) < std::abs(*misfit)) {
            offer(u_before, other, branch, partner);
          }
          before = previous;
          previous = misfit;
          u_before = u;
        }
      }
    }
  }

  std::vector<SplineSeed> take() { return std::move(seeds_); }

 private:
  std::optional<double> misfit_at(const Other& other, double u, double branch) const {
    const auto cubic = cubic_at(*base_, other, u, branch);
    if (!cubic) {
      return std::nullopt;
    }
    return kappa_s_misfit(at_other(*cubic, other, u), other.kappa_s);
  }

  /// A root by the Illinois variant of regula falsi.
  double root(const Other& other, double branch, double u0, double f0, double u1, double f1) const {
    for (int i = 0; i < kRootIterations && f1 != 0.0 && f0 != f1; ++i) {
      const double u = u1 - f1 * (u1 - u0) / (f1 - f0);
      const auto f = misfit_at(other, u, branch);
      if (!f) {
        break;
      }
      if (*f * f1 < 0.0) {
        u0 = u1;
        f0 = f1;
      } else {
        f0 *= 0.5;
      }
      u1 = u;
      f1 = *f;
    }
    return u1;
  }

  void offer(double u, const Other& other, double branch, std::size_t partner) {
    const auto cubic = cubic_at(*base_, other, u, branch);
    if (!cubic) {
      return;
    }
    double sum = std::pow(kappa_s_misfit(at_other(*cubic, other, u), other.kappa_s), 2);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (&points_[i] != base_ && i != partner) {
        sum += disagreement(*cubic, seen_from(*base_, points_[i]));
      }
    }
    const double mean = sum / static_cast<double>(points_.size() - 1);
    if (seeds_.size() == wanted_ && mean >= seeds_.back().disagreement) {
      return;
    }
    auto seed = canonical_seed(*cubic, base_->tangent_angle);
    if (!seed) {
      return;
    }
    seed->disagreement = mean;
    const auto at = std::upper_bound(
        seeds_.begin(), seeds_.end(), *seed,
        [](const SplineSeed& p, const SplineSeed& q) { return p.disagreement < q.disagreement; });
    seeds_.insert(at, *seed);
    if (seeds_.size() > wanted_) {
      seeds_.pop_back();
    }
  }

  std::span<const MeasuredGeometry> points_;
  std::size_t wanted_;
  std::array<double, kStepsPerSide> distances_;
  const MeasuredGeometry* base_ = nullptr;
  std::vector<SplineSeed> seeds_;
};

}  // namespace

std::vector<SplineSeed> spline_seeds(std::span<const MeasuredGeometry> points, int wanted) {
  if (points.size() < 2 || wanted < 1) {
    return {};
  }
  // The base is the point of the largest size. The others then lie at distances of order one or
  // more, and none is below the smallest distance.
  const auto size = [](const MeasuredGeometry& p) { return curvature_scale({&p, 1}); };
  std::size_t base = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    base = size(points[i]) > size(points[base]) ? i : base;
  }
  SeedSearch search(points, wanted);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i != base) {
      search.search_pair(base, i);
    }
  }
  return search.take();
}

}  // namespace palpate
