// One slide: the best placement that puts a given place of the part on the reference's normal.
#pragma once

#include <limits>
#include <span>

#include "core/part/part_fit.h"

namespace palpate {

/// Sums are kept as logarithms: where a part does not fit, chi-square varies by more than exp() can
/// represent.
inline constexpr double kLogOfZero = -std::numeric_limits<double>::infinity();

/// Excess of chi-square over the best that counts as negligible: no integral over a part makes up
/// for a factor of exp(-60 / 2).
inline constexpr double kNegligibleRise = 60.0;

/// Between two places whose densities differ only by a factor of exp(1/2), the trapezoid is right
/// to 2 %. [of chi-square]
inline constexpr double kTrapezoidStep = 1.0;

/// The best fit with the part's place t on the normal of the reference.
struct PartSlide {
  double t = 0.0;
  double chi2 = 0.0;
  double log_volume = 0.0;  ///< log of the integral over height and turn, times ds/dt
  Pose2 data_T_part;

  double log_density() const { return -0.5 * chi2 + log_volume; }
};

/// The slides of one reference, a point with a tangent.
class SlideScan {
 public:
  /// `direction`: +1 if the tangent is that of increasing t, -1 if against it.
  SlideScan(const ScaledPart& part, std::span<const FitPoint> points, const FitPoint& reference,
            int direction);

  /// The reference, moved from the tip's centre to the surface.
  const Vec2& surface() const { return surface_; }
  int direction() const { return direction_; }
  /// The normal of the reference, left of increasing t.
  const Vec2& left() const { return left_; }

  /// The fit at place t from the turn that lays the part along the tangent.
  PartSlide at(double t) const;

  /// The fit at place t that is reached from `start`, over height and turn.
  PartSlide from(double t, const Pose2& start) const;

 private:
  const ScaledPart& part_;
  std::span<const FitPoint> points_;
  Vec2 tangent_ = Vec2::Zero();  ///< of increasing t, in the frame of the points
  int direction_;
  Vec2 left_ = Vec2::Zero();  ///< of increasing t, likewise
  Vec2 surface_ = Vec2::Zero();
  PartMotions motions_;
};

/// Whether two fits are the same optimum: less than a hundredth of a standard deviation apart, or
/// equal up to the rounding of turn and place.
bool is_same(const PartFit& a, const PartFit& b);

}  // namespace palpate
