#include "core/recognition/tree_beside.h"

#include <optional>

#include "core/recognition/tree_answer.h"

namespace palpate {
namespace {

/// Where a class's fit on the samples lies.
std::optional<CurveStart> curve_of(const Weighing& w, CurveClass curve_class) {
  const auto i = static_cast<std::size_t>(curve_class);
  const auto start = [](const CanonicalFit& fit) {
    return CurveStart{fit.shape.values, fit.world_T_curve.theta};
  };
  if (w.canonical[i]) {
    return start(*w.canonical[i]);
  }
  const auto& coarse = w.coarse[i];
  const auto canonical =
      coarse && !coarse->at_limit ? to_canonical(*coarse, w.reduced) : std::nullopt;
  return canonical ? std::optional(start(*canonical)) : std::nullopt;
}

}  // namespace

TreeResult tree_beside(const Weighing& w, std::span<const LocalizedContact> contacts,
                       const RecognitionTreeOptions& options) {
  TreeEffort effort;
  effort.known = [&w](CurveClass curve_class) { return curve_of(w, curve_class); };
  // Of a chi-square within its threshold a thousandth changes the p-value by a hundredth of its
  // own.
  effort.fit.relative_decrease = 1e-3;
  effort.fit.max_iterations = 20;
  return recognise_by_tree(tree_points(contacts), options, effort);
}

}  // namespace palpate
