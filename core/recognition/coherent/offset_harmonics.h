// The harmonics of what a probe adds to its samples: orders, coefficients, and how large each is.
#pragma once

#include <algorithm>

#include "core/curves/pose2.h"

namespace palpate {

/// Orders of the offset, a Fourier series of the normal's direction: 0 (the constant) and 2 to a
/// highest one. Order 1 is a shift of the frame. The bending of a stylus and the three legs of a
/// trigger sensor cause lobes of order 2, 3 and 6; their overtones fall off. Probes have lobes up
/// to this order.
inline constexpr int kHighestOrder = 8;

/// Number of coefficients up to an order.
constexpr int offset_coefficients(int highest) { return 1 + 2 * std::max(highest - 1, 0); }

/// Index of the first coefficient of an order (cosine); the sine follows. The constant has one.
constexpr int first_offset_of(int order) { return order == 0 ? 0 : 2 * order - 3; }

/// Size of a harmonic relative to the second: a deviation without sharp bends has harmonics that
/// fall off with the square of their order.
constexpr double overtone(int order) { return order == 0 ? 1.0 : 4.0 / (order * order); }

/// 1, cos 2 phi, sin 2 phi, cos 3 phi ... up to an order, for the direction phi of a unit `normal`:
/// what each coefficient is multiplied by.
template <typename Row>
void set_harmonics(const Vec2& normal, int highest, Row* row) {
  (*row)[0] = 1.0;
  double cosine = normal.x();
  double sine = normal.y();
  for (int k = 2; k <= highest; ++k) {
    const double next = cosine * normal.x() - sine * normal.y();
    sine = sine * normal.x() + cosine * normal.y();
    cosine = next;
    (*row)[first_offset_of(k)] = cosine;
    (*row)[first_offset_of(k) + 1] = sine;
  }
}

}  // namespace palpate
