#include "core/local/stream/straightening.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace palpate {

Straightening::Straightening(std::span<const PathNode> nodes) {
  const Vec2& first = nodes.front().position_m;
  const Vec2& last = nodes.back().position_m;
  const Vec2 chord = last - first;
  const PathNode* nearest = &nodes[nodes.size() / 2];
  double least = std::abs(chord.dot(nearest->position_m - first - 0.5 * chord));
  // Nodes stand for stretches of similar length, so the middle is not in the outer quarters.
  for (const PathNode& node : nodes.subspan(nodes.size() / 4, nodes.size() / 2)) {
    const double off = std::abs(chord.dot(node.position_m - first - 0.5 * chord));
    if (off < least) {
      least = off;
      nearest = &node;
    }
  }
  middle_ = nearest->position_m;
  const Vec2 before = middle_ - first;
  const Vec2 after = last - middle_;
  const double lengths = before.norm() * after.norm();
  const double across = chord.norm();
  if (!(lengths > 0.0 && across > 0.0) || !std::isfinite(lengths)) {
    return;
  }
  // The angle between the tangent and either chord equals the angle between the other chord and the
  // long chord.
  const double sine = cross(before, after) / lengths;
  const Vec2 along = chord / across;
  const std::complex<double> a(along.dot(before), cross(along, before));
  const std::complex<double> b(along.dot(after), cross(along, after));
  const std::complex<double> turn = a * b / lengths;
  if (!std::isfinite(sine) || !(std::abs(turn) > 0.0)) {
    return;
  }
  tangent_ = (turn.real() * along + turn.imag() * left_of(along)) / std::abs(turn);
  half_kappa_ = sine / across;
  least_shrink_ = std::min(to_line(first).shrink, to_line(last).shrink);
}

bool Straightening::turns_beyond(double angle) const {
  return least_shrink_ < 0.5 * (1.0 + std::cos(angle));
}

LocalEstimate Straightening::to_world(const LocalEstimate& at_w) const {
  using Complex = std::complex<double>;
  const Complex i(0.0, 1.0);
  const Complex w(at_w.position.x(), at_w.position.y());
  const Complex q = 1.0 / (1.0 - i * half_kappa_ * w);
  const Complex z = w * q;
  const Complex p_tau = 2.0 * i * half_kappa_ * q * std::polar(1.0, at_w.tangent_angle);
  const double shrink = std::norm(q);  // |g'|, g' = q^2
  LocalEstimate e = at_w;
  e.position = middle_ + z.real() * tangent_ + z.imag() * left_of(tangent_);
  e.tangent_angle =
      wrap_angle(at_w.tangent_angle + 2.0 * std::arg(q) + std::atan2(tangent_.y(), tangent_.x()));
  e.kappa = (at_w.kappa + p_tau.imag()) / shrink;
  e.kappa_s = at_w.kappa_s / (shrink * shrink);
  // Errors are relative to the truth at the foot; an offset moves the point along the normal.
  Eigen::Matrix4d jacobian = Eigen::Matrix4d::Zero();
  jacobian(0, 0) = shrink;
  jacobian(1, 0) = p_tau.real();
  jacobian(1, 1) = 1.0;
  jacobian(2, 0) =
      (0.5 * (p_tau * p_tau).real() + (at_w.kappa + p_tau.imag()) * p_tau.imag()) / shrink;
  jacobian(2, 1) = p_tau.real() / shrink;
  jacobian(2, 2) = 1.0 / shrink;
  jacobian(3, 0) = 2.0 * at_w.kappa_s * p_tau.imag() / (shrink * shrink);
  jacobian(3, 3) = 1.0 / (shrink * shrink);
  e.covariance = jacobian * at_w.covariance * jacobian.transpose();
  return e;
}

double Straightening::arc_m(double from_x_m, double to_x_m) const {
  const double c = half_kappa_;
  if (c * std::max(std::abs(from_x_m), std::abs(to_x_m)) == 0.0) {
    return to_x_m - from_x_m;
  }
  return (std::atan(c * to_x_m) - std::atan(c * from_x_m)) / c;
}

}  // namespace palpate
