#include "core/part/segment_belonging.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "core/numerics/probability/chi_square.h"
#include "core/part/knotted_cubic.h"
#include "core/recognition/samples/cleaned/stored_spikes.h"
#include "core/recognition/smooth/smooth_model.h"

namespace palpate {
namespace {

constexpr int kCubicDegrees = 6;  // shape and pose of a cubic spline segment
constexpr int kBendDegrees = 2;
/// Probability that a patch of one cubic is split.
constexpr double kSignificance = 0.01;
/// Fewest samples on either side of a joint: as many as a cubic needs, and as many again to test
/// it.
constexpr std::size_t kFewestSamples = 2 * kCubicDegrees;
/// Knots tried in a run. A bend one sixteenth of the run away from a knot still shows nearly all of
/// its effect there. More knots would cost significance.
constexpr std::size_t kKnots = 15;

/// Largest number of samples used. The time grows with this times the joints found: some seconds at
/// most. A stroke of 100 mm then has a sample every tenth of a millimetre.
constexpr std::size_t kMostTested = 1000;

/// A run of samples and its most likely cubic.
struct Run {
  FitData data;
  KnottedCubicFit single;
};

std::optional<Run> fit_run(std::span<const StoredSample> samples, const PatchContext& context,
                           double sigma_m) {
  StoredPatch patch;
  patch.context = context;
  patch.samples.assign(samples.begin(), samples.end());
  Run run;
  run.data = make_fit_data(std::span(&patch, 1), sigma_m);
  run.single = fit_single_cubic(run.data);
  if (!std::isfinite(run.single.chi2)) {
    return std::nullopt;
  }
  return run;
}

KnottedCubicFit with_knot(const Run& run, const KnottedCubicFit& start, double knot) {
  KnottedCubicFit trial = start;
  trial.curve.knot = knot;
  return refine_knotted(run.data.points, trial, true);
}

/// The knot with the smallest chi-square between two others, by golden section.
KnottedCubicFit best_between(const Run& run, const KnottedCubicFit& best, double low, double high) {
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  constexpr double kNarrow = 1e-7;  // of the parameter, which runs from -1 to 1
  // Enough from the whole run down to kNarrow. Where no cubic fits, feet may be so far out that no
  // two doubles are that close.
  constexpr int kMostSteps = 35;
  double a = high - ratio * (high - low);
  double b = low + ratio * (high - low);
  KnottedCubicFit at_a = with_knot(run, best, a);
  KnottedCubicFit at_b = with_knot(run, best, b);
  for (int step = 0; step < kMostSteps && high - low > kNarrow; ++step) {
    if (at_a.chi2 < at_b.chi2) {
      high = b;
      b = a;
      at_b = std::move(at_a);
      a = high - ratio * (high - low);
      at_a = with_knot(run, at_b, a);
    } else {
      low = a;
      a = b;
      at_a = std::move(at_b);
      b = low + ratio * (high - low);
      at_b = with_knot(run, at_a, b);
    }
  }
  KnottedCubicFit& better = at_a.chi2 < at_b.chi2 ? at_a : at_b;
  return better.chi2 < best.chi2 ? better : best;
}

/// Finds the joint of a run of samples [begin, end). Indices count from the first sample of the
/// patch.
class JointTest {
 public:
  JointTest(std::span<const StoredSample> samples, const PatchContext& context, double sigma_m)
      : samples_(samples), context_(context), sigma_m_(sigma_m) {}

  std::optional<SegmentJoint> joint_of(std::size_t begin, std::size_t end) const {
    if (end < begin + 2 * kFewestSamples) {
      return std::nullopt;
    }
    auto run = fit_run(samples_.subspan(begin, end - begin), context_, sigma_m_);
    if (!run) {
      return std::nullopt;
    }
    const std::vector<std::size_t> knots = knots_of(end - begin);
    KnottedCubicFit best = run->single;
    std::size_t best_knot = 0;
    for (std::size_t k = 0; k < knots.size(); ++k) {
      KnottedCubicFit trial = with_knot(*run, run->single, run->single.t[knots[k]]);
      if (trial.chi2 < best.chi2) {
        best = std::move(trial);
        best_knot = k;
      }
    }
    const double limit =
        chi_square_threshold(kSignificance / static_cast<double>(knots.size()), kBendDegrees);
    if (!(run->single.chi2 - best.chi2 > limit)) {
      return std::nullopt;
    }
    // The gain of the bend may come from a better optimum of the single cubic; try it.
    KnottedCubicFit unbent = best;
    unbent.curve.bend = Vec2::Zero();
    unbent = refine_knotted(run->data.points, unbent, false);
    const double single = std::min(run->single.chi2, unbent.chi2);
    if (!(single - best.chi2 > limit)) {
      return std::nullopt;
    }
    const auto knot_t = [&](std::size_t k) { return best.t[knots[k]]; };
    const std::size_t last = knots.size() - 1;
    best = best_between(*run, best, knot_t(best_knot > 0 ? best_knot - 1 : 0),
                        knot_t(best_knot < last ? best_knot + 1 : last));
    SegmentJoint joint = located(*run, best);
    // If the fit does not follow the samples in their order, the knot may come out before or behind
    // all of them. Then it splits nothing, and neither side could be tested again.
    if (joint.index < kCubicDegrees || joint.index + kCubicDegrees > end - begin) {
      return std::nullopt;
    }
    joint.index += begin;
    joint.earliest += begin;
    joint.latest += begin;
    return joint;
  }

 private:
  static std::vector<std::size_t> knots_of(std::size_t count) {
    const std::size_t room = count - 2 * kFewestSamples;
    const std::size_t knots = std::min(kKnots, room + 1);
    std::vector<std::size_t> indices;
    for (std::size_t k = 0; k < knots; ++k) {
      indices.push_back(kFewestSamples + (knots > 1 ? k * room / (knots - 1) : room / 2));
    }
    return indices;
  }

  /// Position of the knot, in the units of the run: a place of the curve between the samples on
  /// either side. If the patch is not two smooth cubics, as at a corner, the curve may swing far
  /// out between them, where nothing was touched. Then the position is on the straight line between
  /// the two samples.
  static Vec2 place_of(const Run& run, const KnottedCubicFit& best, std::size_t index) {
    const std::size_t after = std::clamp<std::size_t>(index, 1, best.t.size() - 1);
    const auto touched = [&](std::size_t i) -> Vec2 {
      const FitPoint& point = run.data.points[i];
      return point.position - best.side * point.offset * best.curve.left(best.t[i]);
    };
    const Vec2 from = touched(after - 1);
    const Vec2 to = touched(after);
    Vec2 place = best.curve.position(best.curve.knot);
    // An arc that turns by less than half a circle stays within the circle over its chord; noise
    // adds five standard deviations.
    constexpr double kFarSigmas = 5.0;
    const double within = 0.5 * (to - from).norm() + kFarSigmas * rms_sigma(run.data);
    if ((place - 0.5 * (from + to)).norm() <= within) {
      return place;
    }
    const double step = best.t[after] - best.t[after - 1];
    const double part = (best.curve.knot - best.t[after - 1]) / step;
    return from + (part >= 0.0 && part <= 1.0 ? part : 0.5) * (to - from);
  }

  /// The joint among the samples of the run, and the interval in which it may lie.
  SegmentJoint located(const Run& run, const KnottedCubicFit& best) const {
    const std::size_t n = best.t.size();
    SegmentJoint joint;
    const auto beyond =
        std::find_if(best.t.begin(), best.t.end(), [&](double t) { return t > best.curve.knot; });
    joint.index = static_cast<std::size_t>(beyond - best.t.begin());
    joint.position_m = run.data.frame * (run.data.scale * place_of(run, best, joint.index));
    constexpr double kOutside = 0.05;  // earliest to latest: a 95 % interval
    const double limit = chi_square_threshold(kOutside, 1);
    // Along the whole run, because for a weak bend the possible places may have gaps.
    constexpr std::size_t kMostPlaces = 80;
    const std::size_t stride = n / kMostPlaces + 1;
    joint.earliest = joint.latest = joint.index;
    for (std::size_t i = 0; i < n; i += stride) {
      if (with_knot(run, best, best.t[i]).chi2 - best.chi2 <= limit) {
        joint.earliest = std::min(joint.earliest, i >= stride ? i - stride + 1 : 0);
        joint.latest = std::max(joint.latest, std::min(i + stride, n));
      }
    }
    return joint;
  }

  std::span<const StoredSample> samples_;
  PatchContext context_;
  double sigma_m_;
};

/// Splits a run at its joint, and then the parts that certainly lie on either side. If a part
/// contained a few samples of its neighbour, another joint would be found there.
void part_run(const JointTest& test, std::size_t begin, std::size_t end,
              std::vector<SegmentJoint>* joints) {
  const auto joint = test.joint_of(begin, end);
  if (!joint) {
    return;
  }
  part_run(test, begin, joint->earliest, joints);
  joints->push_back(*joint);
  part_run(test, joint->latest, end, joints);
}

/// Tests each joint again between its neighbours. The first joints were found with others still in
/// the run; if these were misplaced, further joints were found next to them. A joint that the test
/// does not confirm is removed.
void settle(const JointTest& test, std::size_t count, std::vector<SegmentJoint>* joints) {
  constexpr int kPasses = 2;  // the second tests between neighbours that the first has placed
  for (int pass = 0; pass < kPasses && joints->size() > 1; ++pass) {
    for (std::size_t j = 0; j < joints->size();) {
      const std::size_t begin = j > 0 ? (*joints)[j - 1].latest : 0;
      const std::size_t end = j + 1 < joints->size() ? (*joints)[j + 1].earliest : count;
      if (const auto joint = test.joint_of(begin, end)) {
        (*joints)[j++] = *joint;
      } else if (end >= begin + 2 * kFewestSamples) {
        joints->erase(joints->begin() + static_cast<std::ptrdiff_t>(j));
      } else {
        ++j;  // too close to its neighbours to be tested
      }
    }
  }
}

/// Indices of at most kMostTested of `count` samples, evenly spread.
std::vector<std::size_t> tested_of(std::size_t count) {
  const std::size_t tested = std::min(count, kMostTested);
  std::vector<std::size_t> numbers;
  for (std::size_t k = 0; k < tested; ++k) {
    numbers.push_back(k * count / tested);
  }
  return numbers;
}

/// Converts a joint among the tested samples to one among all `count` samples. Samples between two
/// tested ones may lie on either side.
SegmentJoint among_all(SegmentJoint joint, const std::vector<std::size_t>& tested,
                       std::size_t count) {
  const auto first_after = [&](std::size_t i) { return i > 0 ? tested[i - 1] + 1 : 0; };
  const auto at = [&](std::size_t i) { return i < tested.size() ? tested[i] : count; };
  joint.earliest = first_after(joint.earliest);
  joint.latest = at(joint.latest);
  joint.index = (first_after(joint.index) + at(joint.index)) / 2;
  return joint;
}

/// The noise of samples that state none: from the residuals of a smooth model without a class. [m]
double noise_of(const StoredPatch& patch, double sigma_m) {
  FitData data = make_fit_data(std::span(&patch, 1), sigma_m);
  if (data.noise_is_stated) {
    return sigma_m;
  }
  const SmoothModel smooth = fit_smooth_model(&data, false);
  return std::max(smooth.noise_ratio(), rounding_level(data)) * data.scale;
}

}  // namespace

SegmentBelonging longest_segment(const StoredPatch& patch, double sigma_m) {
  SegmentBelonging result;
  constexpr double kFalseSpikes = 0.01;  // probability that a patch without spikes loses a sample
  WorkBudget unbounded;
  const std::vector<bool> is_spike = spikes_of(patch, sigma_m, kFalseSpikes, unbounded);
  StoredPatch kept = without_spikes(patch, is_spike);
  std::vector<std::size_t> numbers;  // of the samples kept
  for (std::size_t i = 0; i < is_spike.size(); ++i) {
    if (!is_spike[i]) {
      numbers.push_back(i);
    }
  }
  result.end = patch.samples.size();
  if (kept.samples.size() < kFewestSamples) {
    return result;
  }
  const double noise_m = noise_of(kept, sigma_m);
  const bool all_known = std::all_of(kept.samples.begin(), kept.samples.end(),
                                     [](const StoredSample& s) { return s.sigma_m > 0.0; });
  if (!all_known) {
    for (StoredSample& sample : kept.samples) {
      sample.sigma_m = noise_m;
    }
  }
  const std::vector<std::size_t> tested = tested_of(kept.samples.size());
  std::vector<StoredSample> tested_samples;
  tested_samples.reserve(tested.size());
  for (const std::size_t i : tested) {
    tested_samples.push_back(kept.samples[i]);
  }
  const JointTest test(tested_samples, kept.context, noise_m);
  part_run(test, 0, tested.size(), &result.joints);
  settle(test, tested.size(), &result.joints);
  for (SegmentJoint& joint : result.joints) {
    joint = among_all(joint, tested, kept.samples.size());
  }

  // The longest run between two joints. `core` excludes the samples that may lie on either side of
  // a joint.
  std::size_t longest = 0;
  const auto begin_of = [&](std::size_t j) { return j > 0 ? result.joints[j - 1].index : 0; };
  const auto end_of = [&](std::size_t j) {
    return j < result.joints.size() ? result.joints[j].index : kept.samples.size();
  };
  for (std::size_t j = 1; j <= result.joints.size(); ++j) {
    longest = end_of(j) - begin_of(j) > end_of(longest) - begin_of(longest) ? j : longest;
  }
  const std::size_t longest_begin = begin_of(longest);
  const std::size_t longest_end = end_of(longest);
  const std::size_t core_begin = longest > 0 ? result.joints[longest - 1].latest : 0;
  const std::size_t core_end =
      longest < result.joints.size() ? result.joints[longest].earliest : kept.samples.size();
  const auto run = core_end >= core_begin + kFewestSamples
                       ? fit_run(std::span(kept.samples).subspan(core_begin, core_end - core_begin),
                                 kept.context, noise_m)
                       : std::nullopt;
  if (run) {
    result.chi2 = run->single.chi2;
    result.dof = static_cast<int>(core_end - core_begin) - kCubicDegrees;
    result.sigma_m = run->data.scale * rms_sigma(run->data);
  }
  // Converts to the indices of the given samples.
  const auto given = [&](std::size_t i) {
    return i < numbers.size() ? numbers[i] : patch.samples.size();
  };
  for (SegmentJoint& joint : result.joints) {
    joint.index = given(joint.index);
    joint.earliest = given(joint.earliest);
    joint.latest = given(joint.latest);
  }
  result.begin = longest_begin > 0 ? given(longest_begin) : 0;
  result.end = given(longest_end);
  for (std::size_t i = 0; i < patch.samples.size(); ++i) {
    if (i < result.begin || i >= result.end || is_spike[i]) {
      result.outside.push_back(i);
    }
  }
  return result;
}

}  // namespace palpate
