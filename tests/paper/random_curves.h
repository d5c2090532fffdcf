// The random curves and places of the paper's noise-free simulations. The paper prints neither its
// ranges nor its points; these are ours.
#pragma once

#include <cstdint>
#include <random>

#include "core/invariants/measured_geometry.h"
#include "tests/support/canonical_points.h"

namespace palpate::paper {

/// Numbers that are the same on every platform: the standard's distributions are not.
class Random {
 public:
  explicit Random(std::uint64_t stream) : engine_(kSeed * 1000 + stream) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  double sign() { return uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0; }

 private:
  static constexpr std::uint64_t kSeed = 2007;
  std::mt19937_64 engine_;
};

/// A curve in its canonical frame.
test::PlacedCurve curve_of(CurveClass curve_class, double first, double second = 0.0,
                           double third = 0.0);

/// A random curve of table 3. Ranges [m]: sizes 1 to 3, b / a of the ellipse 0.4 to 0.85, |b| and
/// |c| of the cubics up to 2.
test::PlacedCurve random_curve(CurveClass curve_class, Random& random);

/// A random place where the paper's data could have come from: within the bend of the curve, away
/// from inflections (where Icp2 divides by the curvature) and cusps.
double random_place(const test::PlacedCurve& curve, Random& random);

/// Whether two points of that class are not alike: |kappa|^(-2/3) at least 15 % apart for central
/// conics, tangents at least 0.15 rad apart (modulo pi) for the others.
bool are_told_apart(CurveClass curve_class, const MeasuredGeometry& p, const MeasuredGeometry& q);

}  // namespace palpate::paper
