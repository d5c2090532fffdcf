#include "core/local/estimator.h"

#include <algorithm>
#include <array>

#include "core/local/circle_estimator.h"
#include "core/local/finite_difference_estimator.h"
#include "core/local/jet_estimator.h"
#include "core/local/two_round_estimator.h"

namespace palpate {
namespace {

constexpr std::array kKinds = {EstimatorKind::FiniteDifference, EstimatorKind::Circle,
                               EstimatorKind::TwoRound, EstimatorKind::Jet};

TwoRoundOptions two_round_options(const EstimatorOptions& options) {
  return {options.window, options.shift, options.two_round_fits, options.sigma_m};
}

std::size_t shift_of(const EstimatorOptions& options) {
  return static_cast<std::size_t>(std::max(options.shift, 1));
}

}  // namespace

std::string_view name_of(EstimatorKind kind) {
  switch (kind) {
    case EstimatorKind::FiniteDifference:
      return "finite-difference";
    case EstimatorKind::Circle:
      return "circle";
    case EstimatorKind::TwoRound:
      return "two-round";
    case EstimatorKind::Jet:
      return "jet";
  }
  return "unknown";
}

std::optional<EstimatorKind> estimator_kind_from_name(std::string_view name) {
  const auto* found = std::find_if(kKinds.begin(), kKinds.end(),
                                   [&](EstimatorKind kind) { return name_of(kind) == name; });
  return found == kKinds.end() ? std::nullopt : std::optional(*found);
}

std::size_t samples_per_estimate(const EstimatorOptions& options) {
  return options.kind == EstimatorKind::TwoRound
             ? static_cast<std::size_t>(two_round_samples(two_round_options(options)))
             : static_cast<std::size_t>(std::max(options.window, 1));
}

LocalResult estimate_window(std::span<const Vec2> samples, const EstimatorOptions& options) {
  switch (options.kind) {
    case EstimatorKind::FiniteDifference:
      return finite_difference_estimate(samples, options.sigma_m);
    case EstimatorKind::Circle:
      return circle_estimate(samples, options.sigma_m);
    case EstimatorKind::TwoRound:
      return two_round_estimate(samples, two_round_options(options));
    case EstimatorKind::Jet:
      return jet_estimate(samples, {.degree = options.jet_degree, .sigma_m = options.sigma_m});
  }
  return {};
}

std::vector<WindowResult> estimate_all(std::span<const Vec2> samples,
                                       const EstimatorOptions& options) {
  std::vector<WindowResult> results;
  const std::size_t window = samples_per_estimate(options);
  const std::size_t shift = shift_of(options);
  for (std::size_t first = 0; first + window <= samples.size(); first += shift) {
    results.push_back({first, estimate_window(samples.subspan(first, window), options)});
  }
  return results;
}

}  // namespace palpate
