#include "tests/support/stroke.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/curves/curve.h"
#include "tests/support/touched_arc.h"

namespace palpate::test {
namespace {

constexpr double kStep_m = 2e-5;
/// The superellipse (x/a)^4 + (y/b)^4 = 1 and the spiral r = kInner exp(kGrowth phi).
constexpr double kA = 0.030;
constexpr double kB = 0.020;
constexpr double kInner_m = 0.008;
constexpr double kGrowth = 0.15;

struct PolarRadius {
  double r = 0.0, d1 = 0.0, d2 = 0.0, d3 = 0.0;
};

/// r = g^(-1/4) with g = (cos/a)^4 + (sin/b)^4, and its derivatives by the angle.
PolarRadius superellipse(double phi) {
  const double c = std::cos(phi);
  const double s = std::sin(phi);
  const double p = std::pow(kA, -4.0);
  const double q = std::pow(kB, -4.0);
  const double g = p * c * c * c * c + q * s * s * s * s;
  const double g1 = 4.0 * c * s * (q * s * s - p * c * c);
  const double g2 =
      12.0 * c * c * s * s * (p + q) - 4.0 * (q * std::pow(s, 4) + p * std::pow(c, 4));
  const double g3 = 24.0 * (p + q) * (c * s * s * s * -1.0 + c * c * c * s) -
                    16.0 * (q * s * s * s * c - p * c * c * c * s);
  PolarRadius result;
  const double r = result.r = std::pow(g, -0.25);
  const double l1 = g1 / g;
  result.d1 = -0.25 * r * l1;
  result.d2 = r * (5.0 / 16.0 * l1 * l1 - 0.25 * g2 / g);
  result.d3 = r * (-45.0 / 64.0 * l1 * l1 * l1 + 15.0 / 16.0 * l1 * g2 / g - 0.25 * g3 / g);
  return result;
}

PolarRadius spiral(double phi) {
  const double r = kInner_m * std::exp(kGrowth * phi);
  return {r, kGrowth * r, kGrowth * kGrowth * r, kGrowth * kGrowth * kGrowth * r};
}

LocalEstimate polar_geometry(const PolarRadius& p, double phi) {
  const double q = p.r * p.r + p.d1 * p.d1;
  const double n = p.r * p.r + 2.0 * p.d1 * p.d1 - p.r * p.d2;
  const double q1 = 2.0 * p.d1 * (p.r + p.d2);
  const double n1 = 2.0 * p.r * p.d1 + 3.0 * p.d1 * p.d2 - p.r * p.d3;
  LocalEstimate e;
  e.position = p.r * Vec2(std::cos(phi), std::sin(phi));
  e.tangent_angle = wrap_angle(phi + std::atan2(p.r, p.d1));
  e.kappa = n * std::pow(q, -1.5);
  e.kappa_s = (n1 - 1.5 * n * q1 / q) / (q * q);
  return e;
}

/// Walks by arc length from a start, with fourth-order steps of d phi / ds = 1 / sqrt(r^2 + r'^2).
void walk_polar(PolarRadius (*radius)(double), double phi, std::size_t count, TrueStroke* stroke) {
  const auto rate = [&](double at) {
    const PolarRadius p = radius(at);
    return kStep_m / std::hypot(p.r, p.d1);
  };
  for (std::size_t i = 0; i < count; ++i) {
    stroke->truth.push_back(polar_geometry(radius(phi), phi));
    const double k1 = rate(phi);
    const double k2 = rate(phi + 0.5 * k1);
    const double k3 = rate(phi + 0.5 * k2);
    const double k4 = rate(phi + k3);
    phi += (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0;
  }
}

void walk_class(const TouchedArc& arc, double middle, std::size_t count, TrueStroke* stroke) {
  for (std::size_t i = 0; i < count; ++i) {
    const double s =
        arc.direction *
        (middle + kStep_m * (static_cast<double>(i) - 0.5 * static_cast<double>(count - 1)));
    const double t = parameter_at_arc_length(arc.curve, arc.centre_t, s);
    const LocalGeometry local = geometry(arc.curve, t);
    LocalEstimate e;
    e.position = position(arc.curve, t);
    e.tangent_angle = wrap_angle(local.tangent_angle + (arc.direction < 0 ? kPi : 0.0));
    e.kappa = arc.direction * local.kappa;
    e.kappa_s = local.kappa_s;
    stroke->truth.push_back(e);
  }
}

}  // namespace

TrueStroke random_stroke(std::size_t shape, double length_m, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  TrueStroke stroke;
  stroke.step_m = kStep_m;
  const auto count = static_cast<std::size_t>(std::lround(length_m / kStep_m)) + 1;
  const double place = uniform(rng);
  if (shape < touched_arcs().size()) {
    const TouchedArc& arc = touched_arcs()[shape];
    stroke.name = arc.name;
    // Anywhere within 40 mm of the middle of the arc.
    walk_class(arc, 0.04 * (place - 0.5), count, &stroke);
  } else if (shape == touched_arcs().size()) {
    stroke.name = "superellipse";
    walk_polar(superellipse, 2.0 * kPi * place, count, &stroke);
  } else {
    stroke.name = "spiral";
    walk_polar(spiral, 2.0 * kPi * place, count, &stroke);
  }
  const Pose2 pose{0.2 * uniform(rng), 0.2 * uniform(rng), 2.0 * kPi * uniform(rng)};
  for (LocalEstimate& e : stroke.truth) {
    e.position = pose * e.position;
    e.tangent_angle = wrap_angle(e.tangent_angle + pose.theta);
  }
  return stroke;
}

std::size_t usual_stride(const TrueStroke& stroke) {
  const auto steps = static_cast<double>(stroke.truth.size() - 1);
  return static_cast<std::size_t>(std::clamp(steps / 60.0, 1.0, 2e-4 / stroke.step_m));
}

std::vector<Vec2> TrueStroke::samples(std::size_t stride) const {
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < truth.size(); i += stride) {
    points.push_back(truth[i].position);
  }
  return points;
}

Eigen::Vector3d TrueStroke::error_of(const LocalEstimate& estimate) const {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double turn = std::abs(wrap_angle(truth[i].tangent_angle - estimate.tangent_angle));
    const double distance = (truth[i].position - estimate.position).squaredNorm();
    if (turn < 0.5 * kPi && distance < least) {
      least = distance;
      nearest = i;
    }
  }
  const LocalEstimate& e = truth[nearest];
  const Vec2 tangent(std::cos(e.tangent_angle), std::sin(e.tangent_angle));
  const double s = tangent.dot(estimate.position - e.position);
  // kappa_s by a parabola through the neighbouring points, kappa by its integral.
  const std::size_t middle = std::clamp<std::size_t>(nearest, 1, truth.size() - 2);
  const double before = truth[middle - 1].kappa_s;
  const double at = truth[middle].kappa_s;
  const double after = truth[middle + 1].kappa_s;
  const double first = (after - before) / (2.0 * step_m);
  const double second = (after - 2.0 * at + before) / (step_m * step_m);
  const double x = s + (static_cast<double>(nearest) - static_cast<double>(middle)) * step_m;
  return {
      wrap_angle(estimate.tangent_angle - e.tangent_angle - e.kappa * s - 0.5 * e.kappa_s * s * s),
      estimate.kappa - (truth[middle].kappa + x * (at + x * (first / 2.0 + x * second / 6.0))),
      estimate.kappa_s - (at + x * (first + x * second / 2.0))};
}

}  // namespace palpate::test
