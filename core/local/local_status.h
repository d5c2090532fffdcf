// The result of a local estimate, or the reason why there is none.
#pragma once

#include <string_view>

#include "core/local/local_estimate.h"

namespace palpate {

enum class LocalStatus {
  Ok,
  /// Fewer than the unknowns of the estimator (plus spare residuals if it must estimate the noise).
  TooFewSamples,
  NotFinite,  ///< a sample is NaN or infinite, or its square overflows
  NoExtent,   ///< all samples at one place, or the window is not longer than its noise
  /// Too few distinct places along the window for the polynomial: the probe stood still.
  Unresolved,
  /// Abscissae run back by more than the noise: samples out of order, or a window that turns by
  /// more than a right angle from its axis.
  DoublesBack,
  TurnsTooFar,  ///< the window turns too far for this fit
  NotFollowed,  ///< residuals exceed the noise: a bend that the polynomial cannot follow
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
