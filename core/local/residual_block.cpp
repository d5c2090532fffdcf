#include "core/local/residual_block.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

/// 1 - leverage >= kMinFreedom: below, the sample alone fixes the fit and has no residual.
constexpr double kMinFreedom = 1e-9;

}  // namespace

LocalStatus ResidualBlock::fit(std::span<const Vec2> samples, const std::vector<bool>& use) {
  const auto is_used = [&](std::size_t i) { return use.empty() || use[i]; };
  used_.clear();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (is_used(i)) {
      used_.push_back(samples[i]);
    }
  }
  if (used_.size() <= kDegree + 1) {
    return LocalStatus::TooFewSamples;
  }
  const auto [status, frame] = aligned_frame(used_);
  if (status != LocalStatus::Ok) {
    return status;
  }
  frame_ = frame;
  LegendreFit<kDegree> fit;
  for (const Vec2& p : used_) {
    const Vec2 uv = frame.to_frame(p);
    fit.add(uv.x(), uv.y(), 1.0);
  }
  if (!fit.factorise(0.0)) {
    return LocalStatus::Unresolved;
  }
  studentised_m_.resize(samples.size());
  steepest_ = 0.0;
  const auto c = fit.coefficients();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec2 uv = frame.to_frame(samples[i]);
    const Eigen::Matrix<double, 2, kDegree + 1> basis =
        legendre_derivatives<2, kDegree + 1>(uv.x());
    const Eigen::Vector2d at = basis * c;  // value and slope
    const Eigen::Matrix<double, 1, kDegree + 1> row = basis.row(0);
    const double leverage = fit.whitened(row).squaredNorm();
    if (is_used(i)) {
      steepest_ = std::max(steepest_, std::abs(at[1]));
    }
    const double freedom = is_used(i) ? std::max(1.0 - leverage, 0.0) : 1.0 + leverage;
    const double residual = (uv.y() - at[0]) / std::sqrt(1.0 + at[1] * at[1]);
    studentised_m_[i] =
        freedom < kMinFreedom ? 0.0 : frame.half_extent_m * residual / std::sqrt(freedom);
  }
  return LocalStatus::Ok;
}

}  // namespace palpate
