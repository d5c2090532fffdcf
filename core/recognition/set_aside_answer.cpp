#include "core/recognition/set_aside_answer.h"

#include <algorithm>
#include <utility>

#include "core/recognition/counted/outliers.h"
#include "core/recognition/counted/way_set_aside.h"

namespace palpate {
namespace {

/// One flag per sample of `all` that is not used; empty if all are.
std::vector<bool> unused(std::span<const StoredPatch> all, std::span<const StoredPatch> used,
                         const std::vector<bool>& outliers) {
  const auto flagged = std::count(outliers.begin(), outliers.end(), true);
  return flagged == 0 && count_samples(used) == count_samples(all)
             ? std::vector<bool>{}
             : samples_set_aside(all, used, outliers);
}

void tell(std::span<const StoredPatch> all, const std::vector<bool>& aside, Recognition* answer) {
  answer->outliers_m = places_of(flagged_samples(all, aside));
  answer->outlier_count = answer->outliers_m.size();
}

}  // namespace

Recognition with_set_aside(Recognition answer, std::span<const StoredPatch> all,
                           std::span<const StoredPatch> used) {
  tell(all, unused(all, used, {}), &answer);
  return answer;
}

Recognition with_set_aside(Recognition answer, std::span<const StoredPatch> all,
                           std::span<const StoredPatch> used, const Weighed& weighed) {
  const std::vector<bool> aside = unused(all, used, weighed.outliers);
  tell(all, aside, &answer);
  // Where the noise is stated and no sample is set aside, the chi-square of all has judged this.
  const bool is_told = weighed.w.data.noise_is_stated && weighed.outliers.empty();
  const bool is_class = weighed.w.best != CurveClass::Unclassified;
  const auto curve = aside.empty() ? std::nullopt : curve_of(weighed.w);
  if ((weighed.leaves_class && is_class && !is_told) ||
      (curve && has_way_set_aside(all, aside, *curve))) {
    add_doubt(Doubt::Misfit, &answer);
  }
  return answer;
}

}  // namespace palpate
