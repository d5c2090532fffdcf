#include "core/recognition/samples/passes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/local/noise.h"

namespace palpate {
namespace {

constexpr std::size_t kFewestOfPass = 6;

/// Whether there is anything to look at: over a few samples, a step back. Noise makes some too.
bool steps_back(std::span<const StoredSample> samples) {
  constexpr std::size_t kFew = 4;
  for (std::size_t i = 2 * kFew; i < samples.size(); ++i) {
    const Vec2 before = samples[i - kFew].position_m - samples[i - 2 * kFew].position_m;
    const Vec2 after = samples[i].position_m - samples[i - kFew].position_m;
    if (before.dot(after) < 0.0) {
      return true;
    }
  }
  return false;
}

struct Lengths {
  double noise_m = 0.0;  ///< noise does not put a sample so far beside a way
  double far_m = 0.0;    ///< nor two so far apart, in steps too: where noise is as large as a
                         ///< patch, its estimate may be any
};

/// As the samples tell them; nullopt where they do not.
std::optional<Lengths> lengths_of(std::span<const StoredSample> samples) {
  constexpr double kFarDeviations = 10.0;
  constexpr double kFarSteps = 4.0;  // where they are noise alone, seven deviations of it
  std::vector<Vec2> positions;
  std::vector<double> steps;
  positions.reserve(samples.size());
  steps.reserve(samples.size());
  for (const StoredSample& sample : samples) {
    if (!positions.empty()) steps.push_back((sample.position_m - positions.back()).norm());
    positions.push_back(sample.position_m);
  }
  const NoiseEstimate noise = estimate_noise(positions);
  if (noise.status != LocalStatus::Ok) {
    return std::nullopt;
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  const double noise_m = kFarDeviations * noise.sigma_m;
  return Lengths{noise_m, std::max(noise_m, kFarSteps * *middle)};
}

/// Where the stroke, having come from afar, goes back the way it came by more than noise: within
/// half a right angle of it.
std::vector<std::size_t> reversals_of(std::span<const StoredSample> samples, double far_m) {
  std::vector<std::size_t> reversals;
  std::size_t behind = 0;  // far enough from `head` that the two tell the direction
  std::size_t head = 0;    // the farthest on its way
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const Vec2 way = samples[head].position_m - samples[behind].position_m;
    const double length = way.norm();
    if (!(length > far_m)) {
      head = i;
      continue;
    }
    const Vec2 step = samples[i].position_m - samples[head].position_m;
    const double on = step.dot(way) / length;
    if (on < -far_m && std::abs(cross(way, step)) < -on * length) {
      reversals.push_back(head);
      behind = head;
      head = i;
    } else if (on > 0.0) {
      head = i;
      while ((samples[head].position_m - samples[behind + 1].position_m).norm() > far_m) {
        ++behind;
      }
    }
  }
  return reversals;
}

/// How far a place lies from the nearest step of a way through samples; nullopt where that is where
/// the way begins. [m]
std::optional<double> distance_from(std::span<const StoredSample> way, const Vec2& place) {
  double least = std::numeric_limits<double>::infinity();
  bool at_beginning = false;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Vec2 step = way[i].position_m - way[i - 1].position_m;
    const Vec2 to = place - way[i - 1].position_m;
    const double square = step.squaredNorm();
    const double share = square > 0.0 ? std::clamp(to.dot(step) / square, 0.0, 1.0) : 0.0;
    const double distance = (to - share * step).norm();
    if (distance < least) {
      least = distance;
      at_beginning = i == 1 && share == 0.0;
    }
  }
  return at_beginning ? std::nullopt : std::optional(least);
}

/// Whether the pass after a reversal leads back over the one before: as far as the two go, it lies
/// within the noise of it, or within what play and drag of a probe put it beside. One place in four
/// may be a spike's, and half of them must lie so far off that noise did not put them there.
bool leads_back(std::span<const StoredSample> before, std::span<const StoredSample> after,
                const Lengths& lengths) {
  constexpr double kBeside = 0.02;  // of the way from where it turned
  constexpr std::size_t kPlaces = 8;
  const Vec2 turn = before.back().position_m;
  std::size_t on = 0;
  std::size_t compared = 0;
  for (std::size_t k = 1; k <= kPlaces; ++k) {
    const Vec2& place = after[k * (after.size() - 1) / kPlaces].position_m;
    const double off = (place - turn).norm();
    const auto beside = distance_from(before, place);
    if (beside && off > lengths.far_m) {
      ++compared;
      on += *beside <= std::max(lengths.noise_m, kBeside * off) ? 1 : 0;
    }
  }
  return 2 * compared >= kPlaces && 4 * on >= 3 * compared;
}

}  // namespace

std::vector<std::size_t> returns_of(std::span<const StoredSample> samples) {
  std::vector<std::size_t> returns;
  if (samples.size() < 2 * kFewestOfPass || !steps_back(samples)) {
    return returns;
  }
  const auto lengths = lengths_of(samples);
  if (!lengths) {
    return returns;
  }
  const std::vector<std::size_t> reversals = reversals_of(samples, lengths->far_m);
  std::size_t begin = 0;
  for (std::size_t r = 0; r < reversals.size(); ++r) {
    // The sample at the turn ends one pass; the next one begins behind it.
    const std::size_t turn = reversals[r] + 1;
    std::size_t next = r + 1;
    while (next < reversals.size() && reversals[next] + 1 < turn + kFewestOfPass) {
      ++next;
    }
    const std::size_t end = next < reversals.size() ? reversals[next] + 1 : samples.size();
    // The way back is compared with four times as many samples at most: that bounds the time.
    const std::size_t from = turn - std::min(turn - begin, 4 * (end - turn));
    if (turn - begin >= kFewestOfPass && end - turn >= kFewestOfPass &&
        leads_back(samples.subspan(from, turn - from), samples.subspan(turn, end - turn),
                   *lengths)) {
      returns.push_back(turn);
      begin = turn;
    }
  }
  return returns;
}

std::vector<StoredPatch> passes_of(const StoredPatch& patch, std::span<const std::size_t> returns) {
  std::vector<std::size_t> ends(returns.begin(), returns.end());
  ends.push_back(patch.samples.size());
  std::vector<StoredPatch> passes;
  const auto part = [](const auto& all, std::size_t begin, std::size_t end) {
    using Distance = std::ptrdiff_t;
    return std::vector(all.begin() + static_cast<Distance>(begin),
                       all.begin() + static_cast<Distance>(end));
  };
  StoredPatch none = patch;
  none.samples.clear();
  none.details.clear();
  std::size_t begin = 0;
  for (const std::size_t end : ends) {
    StoredPatch pass = none;
    pass.samples = part(patch.samples, begin, end);
    if (!patch.details.empty()) pass.details = part(patch.details, begin, end);
    if (end < patch.samples.size()) {
      pass.newest_m = pass.samples.back().position_m;
    }
    if (passes.size() % 2 == 1) {
      std::reverse(pass.samples.begin(), pass.samples.end());
      std::reverse(pass.details.begin(), pass.details.end());
    }
    passes.push_back(std::move(pass));
    begin = end;
  }
  return passes;
}

}  // namespace palpate
