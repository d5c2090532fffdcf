// Why a local estimator could or could not tell.
#pragma once

#include <string_view>

#include "core/local/local_estimate.h"

namespace palpate {

enum class LocalStatus {
  Ok,
  TooFewSamples,  ///< fewer than the estimator's unknowns (and, where it must estimate the noise,
                  ///< its spare residuals)
  NotFinite,      ///< a sample is NaN or infinite, or so large that its square is
  NoExtent,       ///< all samples in one place, or the window is no longer than its noise
  Unresolved,     ///< too few distinct places along the window for the polynomial: dwelling samples
  DoublesBack,    ///< abscissae run back by more than the noise: samples out of order, or a window
                  ///< that turns by more than a right angle from its axis
  TurnsTooFar,    ///< the window turns too far for this test
  NotFollowed,    ///< residuals larger than the noise: a bend that the polynomial cannot follow
};

/// Lower-case name with underscores ("too_few_samples").
std::string_view name_of(LocalStatus status);

/// An estimate, or the reason why there is none. `estimate` is all zero unless status is Ok.
struct LocalResult {
  LocalStatus status = LocalStatus::TooFewSamples;
  LocalEstimate estimate;

  explicit operator bool() const { return status == LocalStatus::Ok; }
};

}  // namespace palpate
