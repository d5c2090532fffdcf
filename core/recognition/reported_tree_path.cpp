#include "core/recognition/reported_tree_path.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "core/recognition/contacts.h"
#include "core/recognition/tree_answer.h"

namespace palpate {
namespace {

/// The curve of a class's fit to the samples; nullopt if it has none.
std::optional<CurveStart> curve_of(const Weighing& w, CurveClass curve_class) {
  if (const auto& canonical = w.canonical[curve_class]) {
    return CurveStart{canonical->shape.values, canonical->world_T_curve.theta};
  }
  const auto& coarse = w.coarse[curve_class];
  const auto place = coarse ? canonical_place(*coarse, w.reduced) : std::nullopt;
  return place ? std::optional<CurveStart>({place->shape.values, place->world_T_curve.theta})
               : std::nullopt;
}

/// Most contacts used: one more than the tests need, which is three and one to verify. Each costs
/// about 4 us in the most expensive classes, and the tree should add less than 30 us to an answer,
/// however many patches there are.
constexpr std::size_t kMostPoints = 5;

/// Divides the contacts, in order, into as many stretches and takes the best known one of each. So
/// the points lie all around the part, not on the first patches only.
std::vector<std::size_t> spread_out(std::span<const LocalizedContact> contacts) {
  const std::size_t count = std::min(contacts.size(), kMostPoints);
  std::vector<std::size_t> chosen;
  chosen.reserve(count);
  for (std::size_t stretch = 0; stretch < count; ++stretch) {
    std::size_t best = stretch * contacts.size() / count;
    const std::size_t end = (stretch + 1) * contacts.size() / count;
    double least = uncertainty(contacts[best]);
    for (std::size_t i = best + 1; i < end; ++i) {
      if (const double other = uncertainty(contacts[i]); other < least) {
        least = other;
        best = i;
      }
    }
    chosen.push_back(best);
  }
  return chosen;
}

}  // namespace

TreeResult reported_tree_path(const Weighing& w, std::span<const LocalizedContact> contacts,
                              const RecognitionTreeOptions& options) {
  TreeEffort effort;
  effort.known = [&w](CurveClass curve_class) { return curve_of(w, curve_class); };
  // The logarithm of the chi-square tail falls by at most 1/2 per unit, so this changes a p-value
  // by at most a twentieth (a significance of 0.001 to 0.00095). A smaller limit would follow
  // classes on their way to a neighbour, whose valleys fall by a tenth per step.
  effort.fit.absolute_decrease = 0.1;
  effort.fit.relative_decrease = 1e-3;  // far above every threshold
  effort.fit.max_iterations = 20;
  const std::vector<std::size_t> chosen = spread_out(contacts);
  std::vector<LocalizedContact> some;
  some.reserve(chosen.size());
  for (const std::size_t i : chosen) {
    some.push_back(contacts[i]);
  }
  TreeResult tree = recognise_by_tree(tree_points(some), options, effort);
  for (std::size_t& point : tree.pooled) {
    point = chosen[point];
  }
  return tree;
}

Recognition with_tree_path(Recognition answer, const Weighing& w,
                           const RecognitionTreeOptions& options) {
  add_path(reported_tree_path(w, answer.contacts, options), &answer);
  const double p_value = answer.tree_p_values[answer.shape.curve_class];
  if (p_value < options.significance) {
    add_doubt(Doubt::TreeRejects, &answer);
  }
  return answer;
}

}  // namespace palpate
