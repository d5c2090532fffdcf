#include "core/part/part_slides.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/numerics/probability/log_add.h"
#include "core/part/part_slide.h"

namespace palpate {
namespace {

/// A slide of the grid, or that of a candidate's optimum.
struct Slide : PartSlide {
  int candidate = -1;  ///< the candidate whose optimum this is; -1 = none
};

/// Adds the mass between two neighbouring slides to a candidate and to the segment between them.
class Integral {
 public:
  /// `best_chi2`: the smallest chi-square known so far.
  Integral(const SlideScan& scan, const ScaledPart& part, double best_chi2)
      : scan_(scan), part_(part), best_chi2_(best_chi2) {}

  void between(const PartSlide& a, const PartSlide& b, double* log_mass,
               std::vector<double>* by_segment) {
    double log_piece = kLogOfZero;
    halve(a, b, 0, &log_piece);
    *log_mass = log_add(*log_mass, log_piece);
    double& log_segment = (*by_segment)[part_.spline().segment_at(0.5 * (a.t + b.t))];
    log_segment = log_add(log_segment, log_piece);
  }

 private:
  void halve(const PartSlide& a, const PartSlide& b, int depth, double* log_mass) {
    constexpr int kDeepest = 40;  // at which rounding is reached
    const double least = std::min(a.chi2, b.chi2);
    if (!(least < best_chi2_ + kNegligibleRise)) {
      return;
    }
    // Where the part does not fit, the valley may be deeper between two places of the grid. What
    // seemed best before is then negligible, and needs no further halving.
    best_chi2_ = std::min(best_chi2_, least);
    if (std::abs(a.chi2 - b.chi2) < kTrapezoidStep || depth == kDeepest) {
      const double log_half_step = std::log(0.5 * (b.t - a.t));
      *log_mass = log_add(*log_mass, log_half_step + a.log_density());
      *log_mass = log_add(*log_mass, log_half_step + b.log_density());
      return;
    }
    const PartSlide middle = scan_.at(0.5 * (a.t + b.t));
    best_chi2_ = std::min(best_chi2_, middle.chi2);
    halve(a, middle, depth + 1, log_mass);
    halve(middle, b, depth + 1, log_mass);
  }

  const SlideScan& scan_;
  const ScaledPart& part_;
  double best_chi2_;
};

/// All slides of one direction of travel. They are cyclic in t.
struct Circle {
  SlideScan scan;
  std::vector<Slide> slides;
};

Circle scan_circle(const ScaledPart& part, std::span<const FitPoint> points,
                   const FitPoint& reference, int direction) {
  Circle circle{SlideScan(part, points, reference, direction), {}};
  for (int i = 0; i < part.node_count(); ++i) {
    circle.slides.push_back({circle.scan.at(ScaledPart::node_t(i))});
  }
  return circle;
}

/// Refines the minima of the grid. Each new optimum becomes a candidate.
void add_candidates(const ScaledPart& part, std::span<const FitPoint> points,
                    const FitPoint& reference, const Circle& circle,
                    std::vector<PartCandidate>* candidates) {
  const std::size_t n = circle.slides.size();
  PartMotions motions;
  motions.pivot = circle.scan.surface();
  for (std::size_t i = 0; i < n; ++i) {
    const double chi2 = circle.slides[i].chi2;
    if (!std::isfinite(chi2) || chi2 > circle.slides[(i + 1) % n].chi2 ||
        chi2 > circle.slides[(i + n - 1) % n].chi2) {
      continue;
    }
    PartCandidate candidate;
    candidate.fit = fit_part(part, points, circle.slides[i].data_T_part, motions);
    candidate.direction = circle.scan.direction();
    candidate.t = part.foot_of(candidate.fit.data_T_part.to_local(motions.pivot));
    // A hopeless start may turn round. Its optimum then belongs to the other direction of travel.
    const Vec2 tangent =
        candidate.fit.data_T_part.rotate(part.spline().derivatives(candidate.t).first);
    const bool turned = candidate.direction * tangent.dot(reference.tangent) <= 0.0;
    const bool known =
        std::any_of(candidates->begin(), candidates->end(),
                    [&](const PartCandidate& other) { return is_same(other.fit, candidate.fit); });
    if (!turned && !known && std::isfinite(candidate.fit.chi2)) {
      candidates->push_back(candidate);
    }
  }
}

double log_sum(std::span<const double> logs) {
  return std::accumulate(logs.begin(), logs.end(), kLogOfZero, log_add);
}

/// The masses of the candidates of one direction of travel.
void integrate(const ScaledPart& part, Circle circle, double best_chi2,
               std::span<const PartCandidate> candidates, std::vector<double>* log_masses,
               std::vector<double>* by_segment) {
  std::vector<Slide>& slides = circle.slides;
  bool any = false;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const PartCandidate& candidate = candidates[c];
    if (candidate.direction == circle.scan.direction()) {
      slides.push_back(
          {circle.scan.from(candidate.t, candidate.fit.data_T_part), static_cast<int>(c)});
      any = true;
    }
  }
  if (!any) {
    return;
  }
  std::sort(slides.begin(), slides.end(), [](const Slide& a, const Slide& b) { return a.t < b.t; });
  // Begin at an optimum and close the circle there.
  const auto first = std::find_if(slides.begin(), slides.end(),
                                  [](const Slide& slide) { return slide.candidate >= 0; });
  const auto period = static_cast<double>(part.spline().size());
  for (auto slide = slides.begin(); slide != first; ++slide) {
    slide->t += period;
  }
  std::rotate(slides.begin(), first, slides.end());
  slides.push_back(slides.front());
  slides.back().t += period;

  Integral integral(circle.scan, part, best_chi2);
  for (std::size_t begin = 0; begin + 1 < slides.size();) {
    std::size_t end = begin + 1;
    std::size_t barrier = begin;
    while (slides[end].candidate < 0) {
      barrier = slides[end].chi2 > slides[barrier].chi2 ? end : barrier;
      ++end;
    }
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t owner = i < barrier ? begin : end;
      integral.between(slides[i], slides[i + 1],
                       &(*log_masses)[static_cast<std::size_t>(slides[owner].candidate)],
                       by_segment);
    }
    begin = end;
  }
}

}  // namespace

void set_probabilities(std::span<const double> log_masses, std::span<const double> by_segment,
                       SlidePosterior* posterior) {
  std::vector<PartCandidate>& candidates = posterior->candidates;
  const double whole = log_sum(log_masses);
  posterior->segment_probability.assign(by_segment.size(), 0.0);
  if (!std::isfinite(whole)) {
    candidates.clear();  // the points determine no pose of the part
    return;
  }
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    candidates[c].probability = std::exp(log_masses[c] - whole);
  }
  // Normalised by their own sum, because the logarithm of a very large number keeps few digits.
  const double of_segments = log_sum(by_segment);
  for (std::size_t segment = 0; segment < by_segment.size(); ++segment) {
    posterior->segment_probability[segment] = std::exp(by_segment[segment] - of_segments);
  }
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const PartCandidate& a, const PartCandidate& b) { return a.probability > b.probability; });
}

SlidePosterior slide_posterior(const ScaledPart& part, std::span<const FitPoint> points,
                               const FitPoint& reference, const TravelDirections& directions) {
  SlidePosterior posterior;
  std::vector<PartCandidate>& candidates = posterior.candidates;
  std::vector<Circle> circles;
  for (const int direction : {1, -1}) {
    if (direction > 0 ? directions.along : directions.against) {
      circles.push_back(scan_circle(part, points, reference, direction));
      add_candidates(part, points, reference, circles.back(), &candidates);
    }
  }
  double best = std::numeric_limits<double>::infinity();
  for (const PartCandidate& candidate : candidates) {
    best = std::min(best, candidate.fit.chi2);
  }
  std::erase_if(candidates, [&](const PartCandidate& candidate) {
    return !(candidate.fit.chi2 < best + kNegligibleRise);
  });
  std::vector<double> log_masses(candidates.size(), kLogOfZero);
  std::vector<double> by_segment(part.spline().size(), kLogOfZero);
  for (const Circle& circle : circles) {
    for (const Slide& slide : circle.slides) {
      best = std::min(best, slide.chi2);
    }
  }
  for (Circle& circle : circles) {
    integrate(part, std::move(circle), best, candidates, &log_masses, &by_segment);
  }
  set_probabilities(log_masses, by_segment, &posterior);
  return posterior;
}

}  // namespace palpate
