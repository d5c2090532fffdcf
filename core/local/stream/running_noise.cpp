#include "core/local/stream/running_noise.h"

#include <cmath>

namespace palpate {

void RunningNoise::add(const Vec2& position_m) {
  chunk_.push_back(position_m);
  if (chunk_.size() < kChunk) {
    return;
  }
  const NoiseEstimate noise = estimate_noise(chunk_, &scratch_);
  chunk_.clear();
  if (noise.status != LocalStatus::Ok || noise.dof < 1) {
    return;
  }
  if (dof_ > kMostDof) {
    squares_ *= kMostDof / dof_;
    dof_ = kMostDof;
  }
  squares_ += noise.dof * noise.sigma_m * noise.sigma_m;
  dof_ += noise.dof;
}

void RunningNoise::clear() {
  chunk_.clear();
  squares_ = 0.0;
  dof_ = 0.0;
}

std::optional<double> RunningNoise::sigma_m() {
  double squares = squares_;
  double dof = dof_;
  if (dof <= 0.0) {
    const NoiseEstimate noise = estimate_noise(chunk_, &scratch_);
    if (noise.status != LocalStatus::Ok) {
      return std::nullopt;
    }
    dof = noise.dof;
    squares = dof * noise.sigma_m * noise.sigma_m;
  }
  // A Student variable with this many degrees of freedom has the variance dof / (dof - 2).
  constexpr double kFewestDof = 3.0;
  return dof < kFewestDof ? std::nullopt : std::optional(std::sqrt(squares / (dof - 2.0)));
}

}  // namespace palpate
