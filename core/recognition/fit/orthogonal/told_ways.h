// Which way samples of a stroke go along a curve, as far as noise lets them tell it.
#pragma once

#include <algorithm>
#include <cstddef>

#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Of a patch's points, as many as a bend, or a spike along the arc with its neighbours, may turn
/// round. What lets neighbours lie on opposite sides of a curve turns half of them.
inline constexpr std::size_t kMayTurnOneIn = 10;

/// True if so many of a patch's points that show a direction go against the others.
bool turns(std::size_t against, std::size_t points);

/// How often each of two ways was seen.
struct Ways {
  std::size_t forward = 0;
  std::size_t told = 0;

  void add(bool is_forward) {
    ++told;
    forward += is_forward ? 1 : 0;
  }
  bool disagree() const { return turns(std::min(forward, told - forward), told); }
};

/// How far noise goes at most, in units of what the points state: six of its standard deviations.
/// It has no size there where nobody states it and no section shows it; then it is no larger than
/// what leaves as little as the fit does with a negligible probability. Of k degrees of freedom
/// chi-square is below a k with a probability of at most (a exp(1 - a))^(k / 2) (H. Chernoff,
/// 1952), which is below p for a = exp(-1 + 2 log(p) / k).
double farthest_noise(double chi2, const FitData& data);

/// Whether two points' places are so far apart that noise does not turn the direction from one to
/// the other round: it would have to be out by `farthest` of its standard deviations.
bool is_told_apart(const Vec2& a, const FitPoint& from, const Vec2& b, const FitPoint& to,
                   double farthest);
/// The same of the points themselves.
bool tells_direction(const FitPoint& from, const FitPoint& to, double farthest);

}  // namespace palpate
