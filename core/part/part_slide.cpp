#include "core/part/part_slide.h"

#include <Eigen/LU>
#include <cmath>

namespace palpate {

SlideScan::SlideScan(const ScaledPart& part, std::span<const FitPoint> points,
                     const FitPoint& reference, int direction)
    : part_(part),
      points_(points),
      tangent_(direction * reference.tangent),
      direction_(direction),
      left_(left_of(tangent_)),
      surface_(reference.position - part.outside() * reference.offset * left_) {
  motions_.pivot = surface_;
  motions_.columns.resize(3, 2);
  motions_.columns << left_.x(), 0.0, left_.y(), 0.0, 0.0, 1.0;
}

PartSlide SlideScan::at(double t) const {
  const CurveDerivatives d = part_.spline().derivatives(t);
  return from(t, pose_carrying(turn_between(d.first, tangent_), d.position, surface_));
}

PartSlide SlideScan::from(double t, const Pose2& start) const {
  const CurveDerivatives d = part_.spline().derivatives(t);
  // Where the part fits, a few steps are enough. Where it does not fit, precision is not needed.
  constexpr int kMostIterations = 10;
  const PartFit fit = fit_part(part_, points_, start, motions_, kMostIterations);
  PartSlide slide;
  slide.t = t;
  slide.data_T_part = fit.data_T_part;
  const double across = cross(fit.data_T_part.rotate(d.first), left_);
  const double determinant = Eigen::Matrix2d(fit.information).determinant();
  // A placement has no mass if the part has turned to the other direction of travel, or if the
  // points do not determine height and turn.
  const bool tells = across > 0.0 && determinant > 0.0 && std::isfinite(fit.chi2);
  slide.chi2 = tells ? fit.chi2 : std::numeric_limits<double>::infinity();
  slide.log_volume = tells ? std::log(across) - 0.5 * std::log(determinant) : 0.0;
  return slide;
}

bool is_same(const PartFit& a, const PartFit& b) {
  constexpr double kSame = 1e-4;
  constexpr double kRounding = 1e-9;
  const Eigen::Vector3d apart(a.data_T_part.x - b.data_T_part.x, a.data_T_part.y - b.data_T_part.y,
                              wrap_angle(a.data_T_part.theta - b.data_T_part.theta));
  return apart.norm() < kRounding || apart.dot(a.information * apart) < kSame;
}

}  // namespace palpate
