// Which of the minima is told, and how sure the others are excluded.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/recognition/given/given_search.h"
#include "core/recognition/samples/contact_sample.h"

namespace palpate {

struct GivenChoice {
  std::size_t taken = 0;  ///< its index among the minima
  /// The best one with the tips on the other side of the surface; none if there is none, or if it
  /// is told that the tips lie otherwise.
  std::optional<std::size_t> other_side = {};
  std::vector<std::size_t> twins = {};  ///< the others with the tips on the same side, best first
};

/// Takes the best of the minima, which must not be empty, among those that have the tips where the
/// points' stated material and normals say. If these do not tell, among those that have them where
/// `touched_from` says. If nothing tells where tips touch a circle, it is touched from outside.
GivenChoice choose(std::span<const GivenCandidate> minima, const LocalPoints& local,
                   std::span<const GivenPoint> points, TouchedFrom touched_from);

/// True if tips lie on opposite sides of the two curves at most of the points.
bool on_other_side(const GivenCandidate& u, const GivenCandidate& v);

}  // namespace palpate
