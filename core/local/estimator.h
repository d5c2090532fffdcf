// All local estimators behind one interface: for one window, and along a whole patch.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/local/local_status.h"

namespace palpate {

enum class EstimatorKind { FiniteDifference, Circle, TwoRound, Jet };

/// "finite-difference", "circle", "two-round", "jet"; estimator_kind_from_name is the inverse.
std::string_view name_of(EstimatorKind kind);
std::optional<EstimatorKind> estimator_kind_from_name(std::string_view name);

struct EstimatorOptions {
  EstimatorKind kind = EstimatorKind::Jet;
  /// Samples of a window. For the two-round fit: of each first-round window (the paper's n).
  int window = 75;
  /// Samples from one estimate to the next. For the two-round fit also: from one first-round window
  /// to the next (the paper's l).
  int shift = 4;
  double sigma_m = 0.0;     ///< noise of a coordinate; 0 = estimate it from each window [m]
  int jet_degree = 4;       ///< degree of the jet's polynomial
  int two_round_fits = 10;  ///< the paper's m
};

/// Number of samples that one estimate uses: `window`, or n + (m - 1) l for the two-round fit.
std::size_t samples_per_estimate(const EstimatorOptions& options);

/// One estimate, at the middle of the window. `samples` must hold samples_per_estimate(options).
LocalResult estimate_window(std::span<const Vec2> samples, const EstimatorOptions& options);

struct WindowResult {
  std::size_t first_sample = 0;  ///< index of the window's first sample
  LocalResult result;
};

/// Estimates along a patch, one every `shift` samples; empty if the patch is shorter than a window.
std::vector<WindowResult> estimate_all(std::span<const Vec2> samples,
                                       const EstimatorOptions& options);

}  // namespace palpate
