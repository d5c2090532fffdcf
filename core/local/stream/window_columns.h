// The nodes of a window in columns, the layout in which the sums of a fit process several at once.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/curves/pose2.h"
#include "core/local/stream/node_pyramid.h"
#include "core/numerics/polynomials/legendre_sums.h"

namespace palpate {

/// Positions, frame coordinates and weights of the nodes. Does not allocate for a window of a
/// NodePyramid.
class WindowColumns {
 public:
  explicit WindowColumns(std::size_t nodes)
      : count_(nodes),
        many_positions_(nodes > kRoom ? nodes : 0),
        many_(nodes > kRoom ? 3 * padded(nodes) : 0) {
    double* const room = nodes > kRoom ? many_.data() : few_.data();
    const std::size_t length = padded(nodes);
    positions = {nodes > kRoom ? many_positions_.data() : few_positions_.data(), nodes};
    u = {room, length};
    v = {room + length, length};
    weight = {room + 2 * length, length};
  }
  WindowColumns(const WindowColumns&) = delete;
  WindowColumns& operator=(const WindowColumns&) = delete;

  /// Call after all nodes are set: fills the padding up to whole lanes with nodes of weight 0.
  void close() {
    for (std::size_t i = count_; i < u.size(); ++i) {
      u[i] = u[count_ - 1];
      v[i] = 0.0;
      weight[i] = 0.0;
    }
  }

  /// Divides the weights by 1 + slope^2, because isotropic noise has that variance along v. The
  /// slope is that of the polynomial with Legendre coefficients c. Returns the largest |slope|.
  double weigh_by_slope(const Eigen::Matrix<double, 5, 1>& c) {
    // P_1' ... P_4' = 1, 3 u, (15 u^2 - 3) / 2, (35 u^3 - 15 u) / 2
    const std::array<double, 4> power = {c[1] - 1.5 * c[3], 3.0 * c[2] - 7.5 * c[4], 7.5 * c[3],
                                         17.5 * c[4]};
    Lanes steepest = Lanes::Zero();
    for (std::size_t i = 0; i < u.size(); i += kLanes) {
      const Lanes at = Eigen::Map<const Lanes>(&u[i]);
      const Lanes slope = power[0] + at * (power[1] + at * (power[2] + at * power[3]));
      steepest = steepest.max(slope.abs());
      Eigen::Map<Lanes>(&weight[i]) /= 1.0 + slope.square();
    }
    return steepest.maxCoeff();
  }

 private:
  static constexpr std::size_t kLanes = LegendreSums<2, 1>::kLanes;
  using Lanes = LegendreSums<2, 1>::Lanes;
  static constexpr std::size_t kRoom = (NodePyramid::kMostNodes + kLanes - 1) / kLanes * kLanes;

  static std::size_t padded(std::size_t nodes) { return (nodes + kLanes - 1) / kLanes * kLanes; }

  std::size_t count_;
  std::array<Vec2, kRoom> few_positions_;
  std::array<double, 3 * kRoom> few_;
  std::vector<Vec2> many_positions_;
  std::vector<double> many_;

 public:
  std::span<Vec2> positions;
  std::span<double> u, v, weight;
};

}  // namespace palpate
