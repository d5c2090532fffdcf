#include "core/recognition/tree_beside.h"

#include <optional>

#include "core/recognition/tree_answer.h"

namespace palpate {
namespace {

/// Where a class's fit on the samples lies.
std::optional<CurveStart> curve_of(const Weighing& w, CurveClass curve_class) {
  const auto i = static_cast<std::size_t>(curve_class);
  if (const auto& canonical = w.canonical[i]) {
    return CurveStart{canonical->shape.values, canonical->world_T_curve.theta};
  }
  const auto& coarse = w.coarse[i];
  const auto place = coarse ? canonical_place(*coarse, w.reduced) : std::nullopt;
  return place ? std::optional<CurveStart>({place->shape.values, place->world_T_curve.theta})
               : std::nullopt;
}

}  // namespace

TreeResult tree_beside(const Weighing& w, std::span<const LocalizedContact> contacts,
                       const RecognitionTreeOptions& options) {
  TreeEffort effort;
  effort.known = [&w](CurveClass curve_class) { return curve_of(w, curve_class); };
  // The logarithm of the chi-square law's tail falls by at most a half per unit: by this a p-value
  // changes by at most a hundredth of its own.
  effort.fit.absolute_decrease = 0.02;
  effort.fit.relative_decrease = 1e-3;  // far above every threshold
  effort.fit.max_iterations = 20;
  return recognise_by_tree(tree_points(contacts), options, effort);
}

}  // namespace palpate
