// The harmonics of what a probe adds to its samples: orders, coefficients, and how large each is.
#pragma once

#include <algorithm>

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

}  // namespace palpate
