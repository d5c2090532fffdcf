#include "tests/support/touch_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/curves/curve.h"
#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/fit/warm_start.h"
#include "core/recognition/given/given_class.h"
#include "core/recognition/posterior/laplace_evidences.h"
#include "core/recognition/posterior/likelihood_of.h"
#include "core/recognition/smooth/arcs.h"
#include "core/recognition/touches/shortest_way.h"
#include "core/recognition/verdict/determined.h"
#include "core/recognition/weigh/contenders.h"
#include "tests/support/placed_fit.h"
#include "tests/support/scene_data.h"
#include "tests/support/unbounded_work.h"

namespace palpate::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRecognized = 0.95;  // the default of RecognizerOptions

FitData data_of(const LoneTouches& touches, std::size_t every, std::size_t first) {
  SampleMemory memory;
  PatchContext context;
  for (std::size_t i = first; i < touches.scene.patches.size(); i += every) {
    const ContactSample sample{touches.scene.patches[i].front(), touches.scene.sigma_m, 0};
    context.patch = static_cast<std::uint32_t>(i);
    memory.add(context, {&sample, 1});
  }
  return make_fit_data(memory.patches(), 0.0);
}

/// The curve with these parameters; its foot points are those of the touches.
ClassFit placed(const ShapeParameters& shape, const Pose2& world_T_curve, const FitData& data) {
  std::vector<double> t;
  if (const auto curve = make_curve(shape.curve_class, shape.values)) {
    for (const FitPoint& point : data.points) {
      const Vec2 world = data.frame * Vec2(data.scale * point.position);
      t.push_back(foot_point(*curve, world_T_curve.to_local(world)).t);
    }
  }
  return placed_fit(shape, world_T_curve, data, t);
}

/// All optima found, by CurveClass; some may be equal.
using Optima = std::array<std::vector<ClassFit>, 9>;

/// Moves a start to its optimum, and a spline's rival to its own, if it is a curve of its class.
void follow(const ClassFit& start, const FitData& data, Optima* optima) {
  std::vector<ClassFit>& of_class = (*optima)[static_cast<std::size_t>(start.curve_class)];
  ClassFit there = settled(start, data, RivalOf::Best, test::unbounded_work());
  if (there.rival) {
    ClassFit rival = there;
    rival.polynomial = there.rival;
    rival.chi2 = there.rival->chi2;
    rival.rival.reset();
    if (is_what_it_says(rival, data)) {
      of_class.push_back(std::move(rival));
    }
  }
  if (is_what_it_says(there, data)) {
    of_class.push_back(std::move(there));
  }
}

/// Length of the path through the foot points in their order, divided by that of the shortest tree
/// through the touches: two for a needle whose sides share the touches of one edge.
double detour_of(const ClassFit& fit, const FitData& data) {
  const auto canonical = to_canonical(fit, data);
  const auto curve =
      canonical ? make_curve(canonical->shape.curve_class, canonical->shape.values) : std::nullopt;
  if (!curve) {
    return 1.0;
  }
  std::vector<double> t;
  for (const auto& point : canonical->points) {
    t.push_back(point.t);
  }
  std::sort(t.begin(), t.end());
  std::vector<Vec2> feet;
  std::vector<Vec2> touches;
  for (std::size_t i = 0; i < t.size(); ++i) {
    feet.push_back(position(*curve, t[i]) / data.scale);
    touches.push_back(data.points[i].position);
  }
  double closing = 0.0;  // the largest gap of a closed curve, which is not part of the path
  for (std::size_t i = 1; i < feet.size(); ++i) {
    closing = std::max(closing, (feet[i] - feet[i - 1]).norm());
  }
  const double length = length_of(feet);
  const double around = length + (feet.front() - feet.back()).norm() - closing;
  return std::max(domain(*curve).period > 0.0 ? std::min(length, around) : length, 1e-9) /
         shortest_tree(touches);
}

/// Continues fits to some of the touches as curves in the frame of all.
void follow_part(const LoneTouches& touches, std::size_t every, std::size_t first,
                 const FitData& data, Optima* optima) {
  const FitData part = data_of(touches, every, first);
  const ClassFits found = fit_classes(part, test::unbounded_work());
  for (const auto& fit : found) {
    if (!fit || fit->at_limit) {
      continue;
    }
    if (const auto canonical = to_canonical(*fit, part)) {
      follow(placed(canonical->shape, canonical->world_T_curve, data), data, optima);
    }
  }
}

/// True if two starts led to the same curve. A conic has one optimum near the data.
bool is_same_optimum(const ClassFit& a, const ClassFit& b) {
  return !a.polynomial || !b.polynomial || is_same_curve(*a.polynomial, *b.polynomial);
}

/// An ellipse or hyperbola without an optimum of its own is replaced by the parabola.
void take_limits(ClassFits* fits) {
  const auto& parabola = (*fits)[static_cast<std::size_t>(CurveClass::Parabola)];
  for (const CurveClass curve_class : {CurveClass::Ellipse, CurveClass::Hyperbola}) {
    auto& fit = (*fits)[static_cast<std::size_t>(curve_class)];
    if (parabola && (!fit || fit->at_limit)) {
      fit = parabola;
      fit->curve_class = curve_class;
      fit->at_limit = true;
    }
  }
}

}  // namespace

TouchReference reference_of(const LoneTouches& touches) {
  // Relative to the shortest tree: a curve above it goes forth and back.
  constexpr double kNeedle = 1.5;
  Arcs arcs = smooth_arcs(data_of(touches, 1, 0));
  const FitData& data = arcs.smooth.reduced;  // every touch stands for itself
  Optima optima;
  const ClassFits searched = fit_classes(data, test::unbounded_work());
  for (const auto& fit : searched) {
    if (fit && !fit->at_limit) {
      follow(*fit, data, &optima);
    }
  }
  std::vector<GivenPoint> points;
  for (const auto& patch : touches.scene.patches) {
    GivenPoint point;
    point.position_m = patch.front();
    point.sigma_m = touches.scene.sigma_m;
    points.push_back(point);
  }
  for (const CurveClass curve_class : kCurveClasses) {
    const GivenFit given = fit_given_class(curve_class, points);
    if (given.status == GivenStatus::Fitted || given.status == GivenStatus::NotDetermined) {
      follow(placed(given.shape, given.world_T_curve, data), data, &optima);
    }
  }
  constexpr std::size_t kParts = 3;
  constexpr std::size_t kFewestOfPart = 8;
  for (std::size_t first = 0; points.size() >= kParts * kFewestOfPart && first < kParts; ++first) {
    follow_part(touches, kParts, first, data, &optima);
  }
  const Scene& scene = touches.scene;
  follow(placed({scene.curve_class, scene.values}, scene.world_T_curve, data), data, &optima);

  const Likelihood likelihood = likelihood_of(arcs, 0.0);
  const auto truth = static_cast<std::size_t>(scene.curve_class);
  const Evidences of_paths =
      evidences_of_paths(arcs.smooth, likelihood, nullptr, test::unbounded_work());
  TouchReference reference;
  reference.chi2.fill(kInfinity);
  reference.compares_all = true;
  ClassFits fits;
  for (const CurveClass curve_class : kCurveClasses) {
    const auto i = static_cast<std::size_t>(curve_class);
    if (static_cast<int>(points.size()) < degrees_of_freedom(curve_class)) {
      reference.compares_all = false;  // it passes through them in infinitely many ways
      continue;
    }
    std::vector<std::pair<const ClassFit*, double>> distinct;  // with the log of the evidence
    double highest = -kInfinity;
    for (ClassFit& optimum : optima[i]) {
      reference.chi2[i] = std::min(reference.chi2[i], optimum.chi2);
      // Each touch is equally likely anywhere along the curve.
      const double detour = detour_of(optimum, data);
      ClassFits alone;
      alone[i] = optimum;
      const Evidences evidences = evidences_of(alone, alone, arcs.smooth, data, likelihood,
                                               of_paths, test::unbounded_work());
      const double log_of = log_evidence(likelihood, evidences, curve_class, optimum.chi2) -
                            static_cast<double>(points.size()) * std::log(detour);
      if (detour >= kNeedle) {
        continue;
      }
      if (std::none_of(distinct.begin(), distinct.end(),
                       [&](const auto& other) { return is_same_optimum(*other.first, optimum); })) {
        distinct.emplace_back(&optimum, log_of);
      }
      if (!fits[i] || log_of > highest) {
        highest = log_of;
        fits[i] = optimum;
      }
    }
    if (i == truth) {
      double sum = 0.0;
      for (const auto& [fit, log_of] : distinct) {
        sum += std::exp(log_of - highest);
      }
      reference.other_shapes = distinct.empty() ? 0.0 : 1.0 - 1.0 / sum;
    }
    if (!fits[i] && searched[i] && searched[i]->at_limit) {
      fits[i] = searched[i];  // what is known about its limit
    }
  }
  take_limits(&fits);
  Evidences evidences =
      evidences_of(fits, fits, arcs.smooth, data, likelihood, of_paths, test::unbounded_work());
  evidences = integrated(std::move(evidences), fits, fits, arcs.smooth.chi2, data, likelihood,
                         log_odds(kRecognized), test::unbounded_work());
  reference.probabilities = probabilities_of(fits, arcs.smooth.chi2, likelihood, evidences);
  if (const auto placed_truth = fits[truth] ? to_canonical(*fits[truth], data) : std::nullopt) {
    reference.knows_shape = is_determined(placed_truth->shape, placed_truth->covariance, data.scale,
                                          RecognizerOptions().determined_fraction);
  }
  return reference;
}

int* BesideReference::counted_for(Doubt doubt, const TouchReference& reference) {
  if (doubt == Doubt::FewPlaces) {
    return &few_places;
  }
  if (doubt == Doubt::TwoShapes && reference.other_shapes > 1.0 - kRecognized) {
    return &two_shapes;
  }
  return doubt == Doubt::Undetermined && !reference.knows_shape ? &shape_unknown : &other_doubt;
}

void BesideReference::add(const LoneTouches& touches) {
  // Probability by the reference; smaller ones do not change an answer.
  constexpr double kMatters = 0.01;
  // Difference of chi-square that the smooth model of joined touches may cause.
  constexpr double kMissed = kLeastError;
  const CurveClass truth = touches.scene.curve_class;
  Recognizer recognizer;
  add_touches(touches, touches.scene.sigma_m, &recognizer);
  const Recognition answer = recognizer.recognize();
  const TouchReference reference = reference_of(touches);
  const auto told = [&](CurveClass curve_class) {
    return reference.probabilities[static_cast<std::size_t>(curve_class)];
  };
  const auto found = [&](CurveClass curve_class) {
    const Hypothesis* hypothesis = hypothesis_of(answer, curve_class);
    return hypothesis != nullptr ? hypothesis->probability : 0.0;
  };
  ++scenes;
  const bool is_recognized = answer.status == RecognitionStatus::Recognized;
  const bool right = answer.shape.curve_class == truth;
  wrong += is_recognized && !right ? 1 : 0;
  if (reference.compares_all && told(truth) >= kRecognized) {
    ++determined;
    const bool is_sure = found(truth) >= kRecognized;
    sure += is_sure ? 1 : 0;
    recognized += is_recognized && right ? 1 : 0;
    mistaken += is_recognized && !right ? 1 : 0;
    if (is_sure && !is_recognized) {
      ++*counted_for(answer.doubt, reference);
    }
  }
  bool any = false;
  for (const CurveClass curve_class : kCurveClasses) {
    farthest = std::max(farthest, std::abs(told(curve_class) - found(curve_class)));
    const Hypothesis* hypothesis = hypothesis_of(answer, curve_class);
    const double least = reference.chi2[static_cast<std::size_t>(curve_class)];
    any = any || (told(curve_class) > kMatters &&
                  !(hypothesis != nullptr && hypothesis->chi2 <= least + kMissed));
  }
  missed += any ? 1 : 0;
}

BesideReference& BesideReference::operator+=(const BesideReference& other) {
  scenes += other.scenes;
  determined += other.determined;
  sure += other.sure;
  recognized += other.recognized;
  few_places += other.few_places;
  two_shapes += other.two_shapes;
  shape_unknown += other.shape_unknown;
  other_doubt += other.other_doubt;
  mistaken += other.mistaken;
  wrong += other.wrong;
  missed += other.missed;
  farthest = std::max(farthest, other.farthest);
  return *this;
}

}  // namespace palpate::test
