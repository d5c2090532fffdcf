#include "node/tool/drawing/visible_samples.h"

#include <cmath>
#include <cstdint>
#include <unordered_set>

namespace palpate {
namespace {

/// A key of the square and colour. Keys of neighbouring squares differ; those of squares 2^28 apart
/// in x or y may coincide, which is far beyond any picture.
std::uint64_t key_of(const Vec2& position, double cell_m, std::size_t colour) {
  // In floating point: positions may be beyond any integer.
  constexpr double kPeriod = 1 << 28;
  const auto index = [cell_m](double value) {
    const double cells = std::fmod(std::floor(value / cell_m), kPeriod);
    return std::isfinite(cells) ? static_cast<std::uint64_t>(cells < 0.0 ? cells + kPeriod : cells)
                                : 0;
  };
  return (static_cast<std::uint64_t>(colour) << 56) | (index(position.x()) << 28) |
         index(position.y());
}

VisibleSamples with_cell(const ContactGroup& group, double cell_m, std::size_t colours) {
  VisibleSamples visible;
  visible.cell_m = cell_m;
  visible.of_run.resize(group.runs.size());
  std::unordered_set<std::uint64_t> taken;
  for (std::size_t number = 0; number < group.runs.size(); ++number) {
    const auto& samples = group.runs[number].samples;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (taken.insert(key_of(samples[i].position_m, cell_m, number % colours)).second) {
        visible.of_run[number].push_back(i);
        ++visible.drawn;
      } else {
        ++visible.left_out;
      }
    }
  }
  return visible;
}

}  // namespace

VisibleSamples visible_samples(const ContactGroup& group, double cell_m, std::size_t most,
                               std::size_t colours) {
  VisibleSamples visible = with_cell(group, cell_m, colours);
  while (visible.drawn > most) visible = with_cell(group, 2.0 * visible.cell_m, colours);
  return visible;
}

}  // namespace palpate
