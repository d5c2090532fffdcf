#include "core/recognition/sample_doubts.h"

#include "core/recognition/counted/fewest_places.h"
#include "core/recognition/samples/stroke_order.h"

namespace palpate {
namespace {

/// Whether the points spread over an extent that double precision resolves.
bool have_extent(const FitData& data) {
  // A shape of five parameters needs digits: a thousand roundings across.
  constexpr double kMostRounding = 1e-3;
  // Squares of coordinates and of their inverses must be numbers.
  constexpr double kSmallest = 1e-100;
  constexpr double kLargest = 1e100;
  return rounding_level(data) < kMostRounding && data.scale > kSmallest && data.scale < kLargest;
}

/// At how many places an answer's class can be RECOGNIZED, by evidence and of stated noise. A
/// sample that is set aside is an unknown more.
std::size_t fewest_places_for(const Recognition& answer) {
  const CurveClass curve_class = answer.shape.curve_class;
  if (curve_class == CurveClass::Unclassified) {
    return kFewestPlaces;
  }
  return fewest_places(curve_class) + answer.outlier_count;
}

}  // namespace

bool can_answer(const FitData& data, std::size_t patches) {
  const std::size_t fewest = patches < kFewestPatches ? kFewestPlaces : kFewestPatches;
  return have_places(data, fewest) && have_extent(data);
}

Recognition with_sample_doubts(Recognition answer, const FitData& data,
                               std::span<const StoredPatch> patches, bool by_evidence) {
  const bool stated = data.noise_is_stated;
  // Where nobody states the noise of touches in any order, some curve goes through them all if that
  // noise is taken for large enough.
  if (!stated && are_mostly_touches(patches) && answer.sigma_m > kLargestNoise * data.scale) {
    add_doubt(Doubt::Misfit, &answer);
  }
  // Touches in any order that are sent as one stroke: no smooth path leads through them. Then any
  // part looks like one of no class, and a noise that the path tells is far too large.
  const bool by_path = !stated || answer.shape.curve_class == CurveClass::Unclassified;
  if (by_path && lead_mostly_to_and_fro(patches)) {
    add_doubt(Doubt::Misfit, &answer);
  }
  const std::size_t fewest = by_evidence && stated ? fewest_places_for(answer) : kFewestPlaces;
  if (!have_places(data, fewest, stated ? 0.0 : answer.sigma_m / data.scale)) {
    add_doubt(Doubt::FewPlaces, &answer);
  }
  return answer;
}

}  // namespace palpate
