// The curve of the tips' centres, sought only if it is asked for.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/weigh/side_choice.h"
#include "core/recognition/weigh/sided_start.h"

namespace palpate {

/// The curve that fits the tips' centres best, sought, or followed, when it is asked for.
class CurveOfCentres {
 public:
  CurveOfCentres(const SideContext& by, std::span<const SidedStart> starts)
      : by_(by), starts_(starts), sides_(by.arcs.smooth.reduced.patches.size(), 0) {}

  /// Its points are the smooth model's reduced ones; nullopt where no class fits.
  const std::optional<CanonicalFit>& get();

  /// Where the classes are to be followed from along its directions, once get() has been asked:
  /// where none fits the centres themselves, a search has shown that. nullptr where one does.
  const WarmStart* start() const { return start_.polynomials.every_seed ? &start_ : nullptr; }

  /// Every class fitted to the centres themselves; nullptr where nobody asked for the curve.
  const ClassFits* fits() const { return sought_ ? &fits_ : nullptr; }

  /// Where it is to be followed from in the next weighing: tips on neither side; nullopt where
  /// nobody asked for it.
  std::optional<SidedStart> next_start() const {
    return sought_ ? std::optional(SidedStart{sides_, start_}) : std::nullopt;
  }

 private:
  const SideContext& by_;
  std::span<const SidedStart> starts_;
  std::vector<int> sides_;
  bool sought_ = false;
  std::optional<CanonicalFit> curve_;
  ClassFits fits_;
  WarmStart start_;
};

}  // namespace palpate
