// Damped Newton's method for the sum of squared orthogonal distances.
#pragma once

#include <algorithm>
#include <bitset>
#include <cmath>
#include <optional>
#include <utility>

#include "core/recognition/given/placed/orthogonal_squares.h"

namespace palpate {

/// Cholesky factor L of the leading n x n part of `m` with `ridge` added to its diagonal; nullopt
/// if that is not positive definite to rounding.
template <typename T>
std::optional<SquareMatrix<T>> lower_factor(const SquareMatrix<T>& m, std::size_t n, double ridge) {
  using std::sqrt;
  SquareMatrix<T> l{};
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = j; i < n; ++i) {
      T sum = m[i][j];
      if (i == j) {
        sum = sum + T(ridge);
      }
      for (std::size_t k = 0; k < j; ++k) {
        sum = sum - l[i][k] * l[j][k];
      }
      if (i > j) {
        l[i][j] = sum / l[j][j];
      } else if (to_double(sum) > 0.0) {
        l[j][j] = sqrt(sum);
      } else {
        return std::nullopt;
      }
    }
  }
  return l;
}

template <typename T>
std::array<T, kMostUnknowns> solve(const SquareMatrix<T>& l, std::size_t n,
                                   std::array<T, kMostUnknowns> b) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      b[i] = b[i] - l[i][k] * b[k];
    }
    b[i] = b[i] / l[i][i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) {
      b[i] = b[i] - l[k][i] * b[k];
    }
    b[i] = b[i] / l[i][i];
  }
  return b;
}

/// Square root of the information's diagonal: how far one unit of each unknown moves the residuals.
template <typename T>
std::array<double, kMostUnknowns> unit_moves(const SquareMatrix<T>& information, std::size_t n) {
  std::array<double, kMostUnknowns> moves;
  moves.fill(1.0);
  for (std::size_t i = 0; i < n; ++i) {
    const double square = to_double(information[i][i]);
    moves[i] = square > 0.0 ? std::sqrt(square) : 1.0;
  }
  return moves;
}

/// `m` with each unknown scaled to move the residuals by one unit.
template <typename T>
SquareMatrix<T> in_unit_moves(SquareMatrix<T> m, std::size_t n,
                              const std::array<double, kMostUnknowns>& moves) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      m[i][j] = m[i][j] / T(moves[i]) / T(moves[j]);
    }
  }
  return m;
}

/// Unknowns that stay as they are.
using HeldUnknowns = std::bitset<kMostUnknowns>;

/// `m` without them: their steps are zero.
template <typename T>
SquareMatrix<T> without(SquareMatrix<T> m, std::size_t n, const HeldUnknowns& held) {
  for (std::size_t k = 0; k < n; ++k) {
    if (held[k]) {
      for (std::size_t i = 0; i < n; ++i) {
        m[i][k] = T(0.0);
        m[k][i] = T(0.0);
      }
      m[k][k] = T(1.0);
    }
  }
  return m;
}

/// What Newton's step to the minimum, undamped, would gain of the cost; nullopt where there is no
/// minimum ahead. Unknowns that are `held` stay.
template <typename T>
std::optional<double> gain_to_minimum(const Squares<T>& here, std::size_t n,
                                      const HeldUnknowns& held) {
  const auto moves = unit_moves(here.information, n);
  const auto lower = lower_factor(without(in_unit_moves(here.hessian, n, moves), n, held), n, 0.0);
  if (!lower) {
    return std::nullopt;
  }
  std::array<T, kMostUnknowns> slope{};
  for (std::size_t i = 0; i < n; ++i) {
    slope[i] = held[i] ? T(0.0) : here.gradient[i] / T(moves[i]);
  }
  const auto step = solve(*lower, n, slope);
  double gain = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    gain += 0.5 * to_double(step[i] * slope[i]);
  }
  return gain;
}

struct DescentEffort {
  int most_steps = 0;
  double last_step = 0.0;  ///< converged if a step moves the residuals by less
  /// A Newton step shorter than this is taken even if rounding hides the gain.
  double trusted_step = 0.0;
  HeldUnknowns held = {};
};

template <typename T>
struct Descent {
  Squares<T> squares;  ///< at the end
  int steps = 0;
  bool settled = false;  ///< converged to a minimum
};

/// Minimises from `curve`. `seat(curve)` sets the feet of a trial curve and returns whether it
/// belongs to the class.
template <typename T, typename Seat>
Descent<T> descend(PlacedCurve<T>* curve, std::span<const WeighedPoint<T>> points,
                   const DescentEffort& effort, const Seat& seat) {
  constexpr double kFirstDamping = 1e-3;   // almost Newton's step
  constexpr double kLeastDamping = 1e-18;  // no effect on a matrix with unit diagonal
  constexpr double kMostDamping = 1e12;
  const auto n = static_cast<std::size_t>(Unknowns(curve->curve_class).count);
  Descent<T> descent;
  descent.squares = squares_about(curve, points);
  double damping = effort.trusted_step > 0.0 ? 0.0 : kFirstDamping;
  while (descent.steps < effort.most_steps && damping < kMostDamping) {
    const Squares<T>& here = descent.squares;
    const auto moves = unit_moves(here.information, n);
    const auto exact =
        lower_factor(without(in_unit_moves(here.hessian, n, moves), n, effort.held), n, damping);
    const auto lower =
        exact ? exact
              : lower_factor(without(in_unit_moves(here.information, n, moves), n, effort.held), n,
                             std::max(damping, kLeastDamping));
    if (!lower) {
      damping = std::max(10.0 * damping, kLeastDamping);
      ++descent.steps;
      continue;
    }
    std::array<T, kMostUnknowns> step{};
    for (std::size_t i = 0; i < n; ++i) {
      step[i] = effort.held[i] ? T(0.0) : -here.gradient[i] / T(moves[i]);
    }
    step = solve(*lower, n, step);
    double length = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      length = std::max(length, std::abs(to_double(step[i])));
      step[i] = step[i] / T(moves[i]);
    }
    ++descent.steps;
    if (!std::isfinite(length)) {
      return descent;
    }
    PlacedCurve<T> trial = *curve;
    trial.move(step.data());
    const bool trusted = exact && damping <= kLeastDamping && length <= effort.trusted_step;
    if (seat(&trial)) {
      Squares<T> there = squares_about(&trial, points);
      const double gain = to_double(here.cost - there.cost);
      if (gain > 0.0 || trusted) {
        *curve = std::move(trial);
        descent.squares = there;
        damping = damping > kLeastDamping ? 0.1 * damping : 0.0;
        // A damped step can be short far from the minimum.
        if (length <= effort.last_step && damping < 0.1) {
          descent.settled = exact.has_value();
          return descent;
        }
        continue;
      }
    }
    if (length <= effort.last_step) {
      // Damping makes a step short anywhere, also where rounding hides what there is to gain.
      constexpr double kRounding = 1e-9;  // of a sum
      const std::optional<double> left =
          damping < 0.1 ? std::optional(0.0) : gain_to_minimum(here, n, effort.held);
      descent.settled = exact && left && *left <= kRounding * to_double(here.cost);
      return descent;
    }
    damping = std::max(8.0 * damping, 1e-6);
  }
  return descent;
}

}  // namespace palpate
