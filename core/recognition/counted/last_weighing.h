// What the last weighing of an object left, so that the next one follows it.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/recognition/counted/counted_samples.h"
#include "core/recognition/counted/weighed.h"
#include "core/recognition/posterior/posterior.h"
#include "core/recognition/weigh/sided_start.h"

namespace palpate {

/// How many samples the memory holds, and how many it has forgotten to make room.
struct MemorySize {
  std::size_t samples = 0;
  std::size_t forgotten = 0;

  /// That have come, and that have gone.
  std::size_t changes() const { return samples + 2 * forgotten; }
};

class LastWeighing {
 public:
  /// Which samples count, and the classes weighed on them: from the last weighing while the object
  /// is touched on in the same patches, else from a new search. `recognized_probability`: as
  /// RecognizerOptions.
  Weighed followed_or_searched(const CountedSamples& counted, const Touched& touched,
                               const MemorySize& memory, double recognized_probability,
                               WorkBudget& work);

  void forget() { last_.reset(); }

 private:
  struct Kept {
    std::vector<SidedStart> starts;
    ClassProbabilities probabilities{};
    MemorySize memory;  ///< at the last search
    std::size_t patches = 0;
    std::optional<ExplainingCurve> explains = {};  ///< spikes, of the best class then
    std::vector<Vec2> off_m = {};                  ///< places of the samples that it misses
  };

  /// nullopt where there are more patches or fewer, or a quarter of the samples has come or gone,
  /// and where a class comes out best that was out, or one is gone that might have kept it from
  /// being RECOGNIZED: following may have lost its fit.
  std::optional<Weighed> followed(const CountedSamples& counted, const Touched& touched,
                                  const MemorySize& memory, double recognized_probability,
                                  WorkBudget& work) const;

  std::optional<Kept> last_;
};

}  // namespace palpate
