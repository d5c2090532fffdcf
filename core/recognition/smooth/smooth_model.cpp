#include "core/recognition/smooth/smooth_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "core/numerics/negligible.h"
#include "core/numerics/orthogonal_polynomials.h"
#include "core/recognition/smooth/turning_sections.h"

namespace palpate {
namespace {

/// Keeps the samples of a section that no polynomial fits as its reduced points.
void keep_points(FitData* data, const PatchSpan& section, SmoothModel* model) {
  const Vec2 first = data->points[section.begin].position;
  const Vec2 along = data->points[section.end - 1].position - first;
  const double whole = along.norm();
  const Vec2& told = data->points[section.begin].tangent;  // of a single touch
  const Vec2 axis = whole > 0.0 ? Vec2(along / whole) : told.isZero() ? Vec2(1.0, 0.0) : told;
  model->sections.push_back({model->reduced.points.size(),
                             model->reduced.points.size() + section.size(), first + 0.5 * along,
                             axis, whole > 0.0 ? 0.5 * whole : 1.0, false, true});
  for (std::size_t i = section.begin; i < section.end; ++i) {
    const std::size_t before = i > section.begin ? i - 1 : i;
    const std::size_t after = i + 1 < section.end ? i + 1 : i;
    const Vec2 chord = data->points[after].position - data->points[before].position;
    const double length = chord.norm();
    if (section.size() > 1) {
      data->points[i].tangent = length > 0.0 ? Vec2(chord / length) : Vec2(0.0, 0.0);
    }
    model->nearest_reduced[i] = static_cast<std::uint32_t>(model->reduced.points.size());
    model->reduced.points.push_back(data->points[i]);
  }
  model->parameters += static_cast<int>(section.size());
  if (section.size() == 1 && data->points[section.begin].inverse_normal_sigma > 0.0) {
    ++model->points;  // one measured direction, and one parameter for it
    ++model->parameters;
  }
}

/// The chord frame of a section: the abscissa runs from -1 to 1, from end to end.
struct ChordFrame {
  Vec2 middle;
  Vec2 axis;
  double half_length;

  double along(const Vec2& p) const { return (p - middle).dot(axis) / half_length; }
  double across(const Vec2& p) const { return cross(axis, p - middle); }
  Vec2 at(double x, double y) const { return middle + half_length * x * axis + y * left_of(axis); }
  Vec2 tangent(double y_by_x) const {
    return (half_length * axis + y_by_x * left_of(axis)).normalized();
  }
};

/// The polynomial of one section.
struct SectionFit {
  PatchSpan section;
  ChordFrame frame;
  OrthogonalPolynomials polynomials;
  int degree = 0;  ///< chosen by the criterion
  /// True if the criterion chooses a degree at least two below the highest possible one even if it
  /// takes the noise from the residuals. Otherwise a higher degree might leave less: the residuals
  /// may be what the polynomial misses of the curve (few samples on a long arc), and show no noise.
  /// Two, because an arc that is nearly symmetric gains only from every second degree. Nor do
  /// samples show noise that are no graph over their chord.
  bool shows_noise = false;

  /// Two degrees more than the criterion chose: terms that are not yet significant in one patch may
  /// distinguish classes when there are several patches.
  int reduced_degree() const { return std::min(degree + 2, polynomials.degree()); }
  bool lacks_degrees() const { return degree + 2 > polynomials.degree(); }
};

/// The noise used to choose a section's degree.
struct Noise {
  bool known = true;      ///< otherwise the criterion profiles it
  double variance = 1.0;  ///< in units of the stated variance
};

/// True if the samples turn too far to be a graph over their chord: by more than two radians, as
/// the chords between the means of their thirds show, which turn a third as much. Sections are cut
/// before that, except where their samples are few. Samples that scatter about a place show no
/// turn: along an even stroke a chord is 3.5 times as long as the scatter of a third about its
/// mean, which is a third of the stroke over sqrt(12); of noise alone it is as long at most.
bool is_no_graph(std::span<const FitPoint> points) {
  constexpr double kLargestTurn = 2.0 / 3.0;  // rad, of chords between thirds
  constexpr double kOfMotion = 2.0;           // chord over scatter, between 1 and 3.5
  const std::size_t n = points.size();
  double scatter = 0.0;
  const auto mean_of = [&](std::size_t begin, std::size_t end) {
    Vec2 sum = Vec2::Zero();
    for (std::size_t i = begin; i < end; ++i) {
      sum += points[i].position;
    }
    Vec2 mean = sum / static_cast<double>(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      scatter += (points[i].position - mean).squaredNorm() / static_cast<double>(n);
    }
    return mean;
  };
  const Vec2 first = mean_of(0, n / 3);
  const Vec2 middle = mean_of(n / 3, n - n / 3);
  const Vec2 before = middle - first;
  const Vec2 after = mean_of(n - n / 3, n) - middle;
  const double least = kOfMotion * kOfMotion * scatter;
  return before.squaredNorm() > least && after.squaredNorm() > least &&
         std::abs(std::atan2(cross(before, after), before.dot(after))) > kLargestTurn;
}

std::optional<SectionFit> fit_section(const FitData& data, const PatchSpan& section,
                                      const Noise& noise) {
  const std::span<const FitPoint> points(data.points.data() + section.begin, section.size());
  const std::size_t n = points.size();
  if (n < kFewestOfSection) {
    return std::nullopt;
  }
  const Vec2 chord = points.back().position - points.front().position;
  const double length = chord.norm();
  if (!(length > 0.0)) {
    return std::nullopt;
  }
  const ChordFrame frame{0.5 * (points.front().position + points.back().position), chord / length,
                         0.5 * length};
  std::vector<double> x(n);
  std::vector<double> y(n);
  std::vector<double> w(n);
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = frame.along(points[i].position);
    y[i] = frame.across(points[i].position);
    w[i] = points[i].inverse_sigma * points[i].inverse_sigma;
  }
  const int highest = std::min<int>(OrthogonalPolynomials::kMaxDegree, static_cast<int>(n) / 2 - 1);

  // A first fit gives the slopes, which convert residuals across the chord into distances.
  constexpr int kSlopeDegree = 3;
  const OrthogonalPolynomials first(x, w, y, std::min(kSlopeDegree, highest));
  for (std::size_t i = 0; i < n; ++i) {
    const double slope = first.evaluate(x[i], first.degree()).derivative / frame.half_length;
    w[i] /= 1.0 + slope * slope;
  }
  SectionFit fit{section, frame, OrthogonalPolynomials(x, w, y, highest), 1};
  const double count = static_cast<double>(n);
  const auto choose = [&](bool noise_known) {
    int degree = 1;
    double best = std::numeric_limits<double>::infinity();
    for (int d = 1; d <= highest; ++d) {
      const double chi2 =
          std::max(fit.polynomials.residual_sum(d), std::numeric_limits<double>::min());
      const double criterion = (noise_known ? chi2 / noise.variance : count * std::log(chi2)) +
                               (d + 1) * std::log(count);
      if (criterion < best) {
        best = criterion;
        degree = d;
      }
    }
    return degree;
  };
  const int by_residuals = choose(false);
  fit.degree = noise.known ? choose(true) : by_residuals;
  fit.shows_noise = by_residuals + 2 <= highest && !is_no_graph(points);
  return fit;
}

void add_smoothed(FitData* data, const SectionFit& fit, SmoothModel* model) {
  const OrthogonalPolynomials& polynomials = fit.polynomials;
  const int degree = fit.reduced_degree();
  model->chi2 += polynomials.residual_sum(degree);
  model->parameters += degree + 1;
  const auto rule = polynomials.gauss_rule(degree);
  const std::size_t begin = model->reduced.points.size();
  const double offset = data->points[fit.section.begin].offset;
  // Bound on a node's weight: no node knows more than all samples together. It acts where the
  // polynomial is steeper than the slopes used for the weights.
  double information = 0.0;
  for (std::size_t i = fit.section.begin; i < fit.section.end; ++i) {
    information += data->points[i].inverse_sigma * data->points[i].inverse_sigma;
  }
  model->sections.push_back({begin, begin + rule.size(), fit.frame.middle, fit.frame.axis,
                             fit.frame.half_length, false, false});
  for (const auto& node : rule) {
    const auto value = polynomials.evaluate(node.x, degree);
    const double slope = value.derivative / fit.frame.half_length;
    // The direction, along which a tip is removed, comes from the chosen degree: two degrees more
    // would swing with the noise.
    const double along = polynomials.evaluate(node.x, fit.degree).derivative;
    model->reduced.points.push_back(
        {fit.frame.at(node.x, value.value), fit.frame.tangent(along),
         std::sqrt(std::min(node.weight * (1.0 + slope * slope), information)), offset});
    if (offset > 0.0) {
      // From the higher degree: the terms that the criterion left out change the direction by less.
      model->reduced.points.back().tangent_sigma =
          std::sqrt(polynomials.slope_variance(node.x, degree)) / fit.frame.half_length;
    }
  }
  for (std::size_t i = fit.section.begin; i < fit.section.end; ++i) {
    const double x = fit.frame.along(data->points[i].position);
    data->points[i].tangent = fit.frame.tangent(polynomials.evaluate(x, fit.degree).derivative);
    std::size_t nearest = 0;
    for (std::size_t k = 1; k < rule.size(); ++k) {
      nearest = std::abs(rule[k].x - x) < std::abs(rule[nearest].x - x) ? k : nearest;
    }
    model->nearest_reduced[i] = static_cast<std::uint32_t>(begin + nearest);
  }
}

/// A section with its polynomial, or without one if its samples stand for themselves.
struct Section {
  PatchSpan points;
  std::optional<SectionFit> fit;

  double chi2() const { return fit->polynomials.residual_sum(fit->reduced_degree()); }
  int dof() const { return fit ? static_cast<int>(points.size()) - fit->reduced_degree() - 1 : 0; }
};

/// Fits a section, or its two halves if even a high degree does not follow it (a sharp bend).
void smooth_section(const FitData& data, const PatchSpan& points, const Noise& noise,
                    std::vector<Section>* sections) {
  auto whole = fit_section(data, points, noise);
  constexpr int kHighDegree = OrthogonalPolynomials::kMaxDegree - 2;
  if (whole && whole->degree >= kHighDegree && points.size() >= 4 * kFewestOfSection) {
    const std::size_t middle = points.begin + points.size() / 2;
    smooth_section(data, {points.begin, middle}, noise, sections);
    smooth_section(data, {middle, points.end}, noise, sections);
    return;
  }
  sections->push_back({points, std::move(whole)});
}

/// True if chi2 is larger than noise of this variance can make it. For white noise chi-square
/// exceeds dof + 2 sqrt(dof x) + 2 x with probability exp(-x) at most (B. Laurent and P. Massart,
/// 2000, lemma 1).
bool is_no_noise(double chi2, int dof, double variance) {
  return dof > 0 && chi2 > variance * (dof + 2.0 * std::sqrt(dof * kNegligibleLogOdds) +
                                       2.0 * kNegligibleLogOdds);
}

/// The quietest sections: those of lowest variance that have a quarter of all degrees of freedom,
/// if noise is stated among sections whose residuals show it. A few badly followed sections do not
/// raise their variance, and it does not depend on the stated noise, which may be too low.
struct QuietSections {
  double highest = 1.0;  ///< largest variance among them, in units of the stated one
  double chi2 = 0.0;     ///< of all of them
  int dof = 0;
};

QuietSections quiet_of(const std::vector<Section>& sections, bool sigma_known) {
  std::vector<std::pair<double, int>> ratios;
  int whole = 0;
  for (const Section& section : sections) {
    if (section.dof() > 0 && (section.fit->shows_noise || !sigma_known)) {
      ratios.emplace_back(section.chi2() / section.dof(), section.dof());
      whole += section.dof();
    }
  }
  std::sort(ratios.begin(), ratios.end());
  QuietSections quiet;
  for (const auto& [ratio, dof] : ratios) {
    quiet.highest = ratio;
    quiet.chi2 += ratio * dof;
    quiet.dof += dof;
    if (4 * quiet.dof >= whole) {
      break;
    }
  }
  return quiet;
}

/// What a section is held against.
struct Yardstick {
  double variance = 1.0;  ///< of the noise, in units of the stated one
  /// The noise is stated, or sections with degrees to spare show it: the others may do without a
  /// polynomial.
  bool shown_elsewhere = true;
};

/// True if the polynomial does not follow a section: it leaves more than noise, because only some
/// of its samples lie in a bend (by chance this happens to fewer than one section in a million, and
/// then costs only time), or its samples are too few for the two degrees more that reduced points
/// need, so that it may swing between them (next to a cusp).
bool is_not_followed(const Section& section, const Yardstick& noise) {
  const int dof = section.dof();
  return dof > 0 && (is_no_noise(section.chi2(), dof, noise.variance) ||
                     (noise.shown_elsewhere && section.fit->lacks_degrees()));
}

/// True if most degrees of freedom are those of sections that have degrees to spare.
bool mostly_with_degrees(const std::vector<Section>& sections) {
  int with = 0;
  int lacking = 0;
  for (const Section& section : sections) {
    if (section.fit) {
      (section.fit->lacks_degrees() ? lacking : with) += section.dof();
    }
  }
  return with > lacking;
}

void cut_until_followed(const FitData& data, Section section, const Noise& noise,
                        const Yardstick& yardstick, std::vector<Section>* sections) {
  const PatchSpan points = section.points;
  if (!is_not_followed(section, yardstick)) {
    sections->push_back(std::move(section));
    return;
  }
  if (points.size() < 2 * kFewestOfSection) {
    sections->push_back({points, std::nullopt});
    return;
  }
  const std::size_t middle = points.begin + points.size() / 2;
  for (const PatchSpan& half : {PatchSpan{points.begin, middle}, PatchSpan{middle, points.end}}) {
    cut_until_followed(data, {half, fit_section(data, half, noise)}, noise, yardstick, sections);
  }
}

/// Halves the sections that are not followed until all are followed or too short for a polynomial.
std::vector<Section> followed(const FitData& data, std::vector<Section> sections,
                              const Noise& noise, const Yardstick& yardstick) {
  if (std::none_of(sections.begin(), sections.end(),
                   [&](const Section& section) { return is_not_followed(section, yardstick); })) {
    return sections;
  }
  std::vector<Section> result;
  for (Section& section : sections) {
    cut_until_followed(data, std::move(section), noise, yardstick, &result);
  }
  return result;
}

/// All patches, cut where they turn and where a high degree does not follow them.
std::vector<Section> smoothed(const FitData& data, const Noise& noise) {
  std::vector<Section> sections;
  for (const PatchSpan& patch : data.patches) {
    if (patch.size() == 0) {
      continue;  // every sample was set aside
    }
    for (const PatchSpan& points : sections_of(data, patch, noise.known)) {
      smooth_section(data, points, noise, &sections);
    }
  }
  return sections;
}

void add_section(FitData* data, const Section& section, SmoothModel* model) {
  if (section.fit) {
    add_smoothed(data, *section.fit, model);
  } else {
    keep_points(data, section.points, model);
  }
}

}  // namespace

double SmoothModel::noise_ratio() const {
  return dof() > 0 ? std::sqrt(chi2 / static_cast<double>(dof())) : 0.0;
}

SmoothModel fit_smooth_model(FitData* data, bool sigma_known) {
  SmoothModel model;
  model.points = static_cast<int>(data->points.size());
  model.nearest_reduced.resize(data->points.size());
  model.reduced.frame = data->frame;
  model.reduced.scale = data->scale;
  Noise noise{sigma_known, 1.0};
  std::vector<Section> sections = smoothed(*data, noise);
  QuietSections quiet = quiet_of(sections, sigma_known);
  if (sigma_known && is_no_noise(quiet.chi2, quiet.dof, 1.0)) {
    // The stated noise is too low everywhere: with it, the fits would follow the noise itself.
    noise.variance = quiet.chi2 / quiet.dof;
    sections = smoothed(*data, noise);
    quiet = quiet_of(sections, sigma_known);
  }
  const Yardstick yardstick{sigma_known ? std::max(quiet.highest, 1.0) : quiet.highest,
                            sigma_known || mostly_with_degrees(sections)};
  sections = followed(*data, std::move(sections), noise, yardstick);

  auto section = sections.begin();
  for (const PatchSpan& patch : data->patches) {
    const std::size_t begin = model.reduced.points.size();
    const auto first = section;
    for (; section != sections.end() && section->points.begin < patch.end; ++section) {
      add_section(data, *section, &model);
      model.sections.back().joined = section != first;
    }
    model.reduced.patches.push_back({begin, model.reduced.points.size()});
  }
  return model;
}

void scale_noise(double factor, FitData* data, SmoothModel* smooth) {
  for (std::vector<FitPoint>* points : {&data->points, &smooth->reduced.points}) {
    for (FitPoint& point : *points) {
      point.inverse_sigma /= factor;
      point.tangent_sigma *= factor;
    }
  }
  smooth->chi2 /= factor * factor;
}

}  // namespace palpate
