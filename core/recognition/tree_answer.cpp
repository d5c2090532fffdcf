#include "core/recognition/tree_answer.h"

#include <cmath>
#include <utility>

#include "core/numerics/probability/chi_square.h"
#include "core/recognition/contacts.h"
#include "core/recognition/tree/tree_covariance.h"
#include "core/recognition/verdict/determined.h"

namespace palpate {
namespace {

/// p-value of the leaf's test.
double tail_probability(const TreeResult& tree) { return chi_square_survival(tree.chi2, tree.dof); }

double rms_sigma_m(std::span<const LocalizedContact> contacts) {
  double squares = 0.0;
  for (const LocalizedContact& contact : contacts) {
    squares += contact.estimate.sigma_m * contact.estimate.sigma_m;
  }
  return contacts.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(contacts.size()));
}

}  // namespace

std::vector<TreePoint> tree_points(std::span<const LocalizedContact> contacts) {
  std::vector<TreePoint> points;
  int patch = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (i > 0 && (contacts[i].probe != contacts[i - 1].probe ||
                  contacts[i].patch != contacts[i - 1].patch)) {
      ++patch;
    }
    points.push_back({contacts[i].estimate, patch});
  }
  return points;
}

void add_path(TreeResult tree, Recognition* answer) {
  answer->decisions = std::move(tree.decisions);
  answer->tree_class = tree.shape.curve_class;
  answer->tree_p_values = tree.p_values;
  answer->invariants = std::move(tree.invariants);
  answer->pooled_contacts = std::move(tree.pooled);
}

Recognition answer_by_tree(
    const std::vector<std::vector<int>>& ways,
    const std::function<std::vector<LocalizedContact>(const std::vector<int>&)>& contacts_of,
    const RecognitionTreeOptions& options, double extent_m, double determined_fraction) {
  Recognition answer;
  TreeResult tree;
  std::size_t classes = 0;
  const std::vector<int>* best = nullptr;
  for (const std::vector<int>& sides : ways) {
    std::vector<LocalizedContact> contacts = contacts_of(sides);
    TreeResult walked = recognise_by_tree(tree_points(contacts), options);
    const bool ends = walked.status == InvariantStatus::Ok &&
                      walked.shape.curve_class != CurveClass::Unclassified;
    const bool better = ends && (classes == 0 || tail_probability(walked) > tail_probability(tree));
    classes += ends ? 1 : 0;
    if (better || answer.contacts.empty()) {
      tree = std::move(walked);
      answer.contacts = std::move(contacts);
      best = &sides;
    }
  }
  if (best != nullptr && best != &ways.back()) {
    answer.contacts = contacts_of(*best);  // the last call must be that for the answer
  }
  answer.sigma_m = rms_sigma_m(answer.contacts);
  Hypothesis only;
  only.shape = tree.shape;
  only.covariance = propagated_covariance(tree_points(answer.contacts), tree, options);
  only.probability = 1.0;
  only.chi2 = tree.chi2;
  only.dof = tree.dof;
  const bool told = tree.status == InvariantStatus::Ok && tree.world_T_curve &&
                    is_determined(tree.shape, only.covariance, extent_m, determined_fraction);
  answer.doubt = classes > 1 ? Doubt::TwoShapes : told ? Doubt::None : Doubt::Undetermined;
  answer.status =
      answer.doubt == Doubt::None ? RecognitionStatus::Recognized : RecognitionStatus::Ambiguous;
  if (tree.world_T_curve) {
    only.world_T_curve = *tree.world_T_curve;
    localise_contacts(only.shape, only.world_T_curve, &answer.contacts);
  }
  answer.shape = only.shape;
  answer.world_T_curve = only.world_T_curve;
  answer.covariance = only.covariance;
  answer.hypotheses.push_back(std::move(only));
  add_path(std::move(tree), &answer);
  return answer;
}

}  // namespace palpate
