#include "core/local/residual_block.h"

#include <algorithm>
#include <cmath>

#include "core/local/legendre_curve.h"

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
  using Fit = LegendreFit<kDegree>;
  Fit fit;
  in_frame_.clear();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    in_frame_.push_back(frame.to_frame(samples[i]));
    if (is_used(i)) {
      fit.add(in_frame_[i].x(), in_frame_[i].y(), 1.0);
    }
  }
  if (!fit.factorise(0.0)) {
    return LocalStatus::Unresolved;
  }
  studentised_m_.resize(samples.size());
  steepest_ = 0.0;
  const Fit::Vector c = fit.coefficients();
  const Fit::Matrix whitening = fit.whitened(Fit::Matrix(Fit::Matrix::Identity()));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec2& uv = in_frame_[i];
    const Fit::Vector basis = legendre<Fit::kSize>(uv.x());
    const double slope_here = slope<Fit::kSize>(c, uv.x());
    const double leverage = (whitening * basis).squaredNorm();
    if (is_used(i)) {
      steepest_ = std::max(steepest_, std::abs(slope_here));
    }
    const double freedom = is_used(i) ? std::max(1.0 - leverage, 0.0) : 1.0 + leverage;
    const double residual = (uv.y() - c.dot(basis)) / std::sqrt(1.0 + slope_here * slope_here);
    studentised_m_[i] =
        freedom < kMinFreedom ? 0.0 : frame.half_extent_m * residual / std::sqrt(freedom);
  }
  return LocalStatus::Ok;
}

}  // namespace palpate
