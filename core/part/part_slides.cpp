#include "core/part/part_slides.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/numerics/log_add.h"

namespace palpate {
namespace {

/// Excess of chi-square over the best that counts as negligible: no integral over a part makes up
/// for a factor of exp(-60 / 2).
constexpr double kNegligible = 60.0;

/// Sums are kept as logarithms: where a part does not fit, chi-square varies by more than exp() can
/// represent.
constexpr double kLogOfZero = -std::numeric_limits<double>::infinity();

/// The best fit with the part's place t on the normal of the reference.
struct Slide {
  double t = 0.0;
  double chi2 = 0.0;
  double log_volume = 0.0;  ///< log of the integral over height and turn, times ds/dt
  Pose2 data_T_part;
  int candidate = -1;  ///< the candidate whose optimum this is; -1 = none
};

class Scan {
 public:
  Scan(const ScaledPart& part, std::span<const FitPoint> points, const FitPoint& reference,
       int direction)
      : part_(part), points_(points), reference_(reference), direction_(direction) {
    left_ = direction_ * left_of(reference_.tangent);
    surface_ = reference_.position - part_.outside() * reference_.offset * left_;
    motions_.pivot = surface_;
    motions_.columns.resize(3, 2);
    motions_.columns << left_.x(), 0.0, left_.y(), 0.0, 0.0, 1.0;
  }

  const Vec2& surface() const { return surface_; }
  int direction() const { return direction_; }

  Slide at(double t) const {
    const CurveDerivatives d = part_.spline().derivatives(t);
    const Vec2 tangent = direction_ * reference_.tangent;
    Pose2 start{0.0, 0.0, turn_between(d.first, tangent)};
    const Vec2 place = surface_ - start.rotate(d.position);
    start.x = place.x();
    start.y = place.y();
    return from(t, start);
  }

  /// The fit at place t that is reached from `start`, over height and turn.
  Slide from(double t, const Pose2& start) const {
    const CurveDerivatives d = part_.spline().derivatives(t);
    // Where the part fits, a few steps are enough. Where it does not fit, precision is not needed.
    constexpr int kMostIterations = 10;
    const PartFit fit = fit_part(part_, points_, start, motions_, kMostIterations);
    Slide slide;
    slide.t = t;
    slide.data_T_part = fit.data_T_part;
    const double across = cross(fit.data_T_part.rotate(d.first), left_);
    const double determinant = Eigen::Matrix2d(fit.information).determinant();
    // A placement has no mass if the part has turned to the other direction of travel, or if the
    // points do not determine height and turn.
    const bool tells = across > 0.0 && determinant > 0.0 && std::isfinite(fit.chi2);
    slide.chi2 = tells ? fit.chi2 : std::numeric_limits<double>::infinity();
    slide.log_volume = tells ? std::log(across) - 0.5 * std::log(determinant) : 0.0;
    return slide;
  }

 private:
  const ScaledPart& part_;
  std::span<const FitPoint> points_;
  const FitPoint& reference_;
  int direction_;
  Vec2 left_ = Vec2::Zero();     ///< of increasing t, in the frame of the points
  Vec2 surface_ = Vec2::Zero();  ///< the reference, moved from the tip's centre to the surface
  PartMotions motions_;
};

/// Adds the mass between two neighbouring slides to a candidate and to the segment between them.
class Integral {
 public:
  /// `best_chi2`: the smallest chi-square known so far.
  Integral(const Scan& scan, const ScaledPart& part, double best_chi2)
      : scan_(scan), part_(part), best_chi2_(best_chi2) {}

  void between(const Slide& a, const Slide& b, double* log_mass, std::vector<double>* by_segment) {
    double log_piece = kLogOfZero;
    halve(a, b, 0, &log_piece);
    *log_mass = log_add(*log_mass, log_piece);
    double& log_segment = (*by_segment)[part_.spline().segment_at(0.5 * (a.t + b.t))];
    log_segment = log_add(log_segment, log_piece);
  }

 private:
  static double log_density(const Slide& slide) { return -0.5 * slide.chi2 + slide.log_volume; }

  void halve(const Slide& a, const Slide& b, int depth, double* log_mass) {
    // Between two places whose densities differ only by a factor of exp(1/2), the trapezoid is
    // right to 2 %.
    constexpr double kStep = 1.0;  // of chi-square
    constexpr int kDeepest = 40;   // at which rounding is reached
    const double least = std::min(a.chi2, b.chi2);
    if (!(least < best_chi2_ + kNegligible)) {
      return;
    }
    // Where the part does not fit, the valley may be deeper between two places of the grid. What
    // seemed best before is then negligible, and needs no further halving.
    best_chi2_ = std::min(best_chi2_, least);
    if (std::abs(a.chi2 - b.chi2) < kStep || depth == kDeepest) {
      const double log_half_step = std::log(0.5 * (b.t - a.t));
      *log_mass = log_add(*log_mass, log_half_step + log_density(a));
      *log_mass = log_add(*log_mass, log_half_step + log_density(b));
      return;
    }
    const Slide middle = scan_.at(0.5 * (a.t + b.t));
    best_chi2_ = std::min(best_chi2_, middle.chi2);
    halve(a, middle, depth + 1, log_mass);
    halve(middle, b, depth + 1, log_mass);
  }

  const Scan& scan_;
  const ScaledPart& part_;
  double best_chi2_;
};

/// Whether two fits are the same optimum: less than a hundredth of a standard deviation apart, or
/// equal up to the rounding of turn and place.
bool is_same(const PartFit& a, const PartFit& b) {
  constexpr double kSame = 1e-4;
  constexpr double kRounding = 1e-9;
  const Eigen::Vector3d apart(a.data_T_part.x - b.data_T_part.x, a.data_T_part.y - b.data_T_part.y,
                              wrap_angle(a.data_T_part.theta - b.data_T_part.theta));
  return apart.norm() < kRounding || apart.dot(a.information * apart) < kSame;
}

/// All slides of one direction of travel. They are cyclic in t.
struct Circle {
  Scan scan;
  std::vector<Slide> slides;
};

Circle scan_circle(const ScaledPart& part, std::span<const FitPoint> points,
                   const FitPoint& reference, int direction) {
  Circle circle{Scan(part, points, reference, direction), {}};
  for (int i = 0; i < part.node_count(); ++i) {
    circle.slides.push_back(circle.scan.at(ScaledPart::node_t(i)));
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
      slides.push_back(circle.scan.from(candidate.t, candidate.fit.data_T_part));
      slides.back().candidate = static_cast<int>(c);
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
    return !(candidate.fit.chi2 < best + kNegligible);
  });
  posterior.segment_probability.assign(part.spline().size(), 0.0);
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
  const double whole = log_sum(log_masses);
  if (!std::isfinite(whole)) {
    candidates.clear();  // the points determine no pose of the part
    return posterior;
  }
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    candidates[c].probability = std::exp(log_masses[c] - whole);
  }
  // Normalised by their own sum, because the logarithm of a very large number keeps few digits.
  const double of_segments = log_sum(by_segment);
  for (std::size_t segment = 0; segment < by_segment.size(); ++segment) {
    posterior.segment_probability[segment] = std::exp(by_segment[segment] - of_segments);
  }
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const PartCandidate& a, const PartCandidate& b) { return a.probability > b.probability; });
  return posterior;
}

}  // namespace palpate
