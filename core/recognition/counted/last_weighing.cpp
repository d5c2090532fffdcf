#include "core/recognition/counted/last_weighing.h"

#include <cmath>
#include <utility>

#include "core/recognition/counted/outliers.h"

namespace palpate {
namespace {

/// A search takes as much as some followed weighings do: ten searches while a patch grows tenfold.
/// Samples that are forgotten change the answer as much as those that come.
constexpr double kChange = 0.25;

/// Whether a class that had more than `most` has less than a fiftieth of it left. New samples of a
/// true class do that to its probability once in fifty times at most (Ville's inequality: against
/// it, likelihood ratios are martingales). So its fit may have been lost. It is for certain where
/// nothing is left of more than a thousandth: that is no evidence against a class but none of it.
bool has_lost_one(const ClassProbabilities& now, const ClassProbabilities& before, double most) {
  constexpr double kLeft = 0.02;
  constexpr double kSeen = 1e-3;
  for (std::size_t i = 1; i < now.size(); ++i) {
    if ((before[i] > most && now[i] < kLeft * before[i]) || (before[i] > kSeen && now[i] == 0.0)) {
      return true;
    }
  }
  return false;
}

}  // namespace

Weighed LastWeighing::followed_or_searched(const CountedSamples& counted, const Touched& touched,
                                           const MemorySize& memory, double recognized_probability,
                                           WorkBudget& work) {
  auto followed = this->followed(counted, touched, memory, recognized_probability, work);
  const bool is_followed = followed.has_value();
  Weighed weighed = is_followed ? *std::move(followed) : counted.searched(touched, work);
  // Samples that are set aside, or taken back, are another matter: what is followed next is the
  // weighing of all.
  Kept kept{weighed.w.starts, weighed.w.probabilities, is_followed ? last_->memory : memory,
            touched.data.patches.size()};
  weighed = counted.settled(std::move(weighed), touched.patches, work);
  kept.explains = weighed.explains;
  kept.off_m = places_of(flagged_samples(patches_of(weighed, touched.patches), weighed.outliers));
  last_ = std::move(kept);
  if (work.was_cut()) {
    last_.reset();  // what was found by then may be far from what there is
  }
  return weighed;
}

std::optional<Weighed> LastWeighing::followed(const CountedSamples& counted, const Touched& touched,
                                              const MemorySize& memory,
                                              double recognized_probability,
                                              WorkBudget& work) const {
  if (!last_ || last_->patches != touched.data.patches.size() ||
      static_cast<double>(memory.changes() - last_->memory.changes()) >
          kChange * static_cast<double>(last_->memory.samples)) {
    return std::nullopt;
  }
  Weighed weighed = counted.followed(touched, last_->starts, last_->explains, last_->off_m, work);
  const Weighing& w = weighed.w;
  // Of a class that had less, a search leaves the fit rough (weigh/contenders.cpp).
  const double out = std::exp(-log_odds(recognized_probability) - 0.5 * kLeastError);
  const bool holds =
      last_->probabilities[w.best] > out &&
      !has_lost_one(w.probabilities, last_->probabilities, 1.0 - recognized_probability);
  return holds || !work.allows() ? std::optional(std::move(weighed)) : std::nullopt;
}

}  // namespace palpate
