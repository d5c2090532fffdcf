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

namespace palpate {
namespace {

/// A section shorter than this tells nothing about noise: of fewer, a parabola leaves no three
/// residuals.
constexpr std::size_t kFewestPoints = 6;
/// So that a section is a graph over its chord. [rad]
constexpr double kLongestTurn = 1.0;

/// Sections of one patch by the turning of chords between means of a few points.
std::vector<PatchSpan> sections_of(const FitData& data, const PatchSpan& patch) {
  // Of four samples at least, whose mean has half of their noise; so many that a radian of a patch
  // that goes all the way round has seven.
  constexpr std::size_t kMostBlocks = 48;
  const std::size_t n = patch.size();
  const std::size_t blocks = std::clamp<std::size_t>(n / 4, 1, kMostBlocks);
  std::vector<Vec2> means(blocks, Vec2::Zero());
  std::vector<std::size_t> starts(blocks + 1);
  for (std::size_t b = 0; b <= blocks; ++b) {
    starts[b] = patch.begin + b * n / blocks;
  }
  for (std::size_t b = 0; b < blocks; ++b) {
    for (std::size_t i = starts[b]; i < starts[b + 1]; ++i) {
      means[b] += data.points[i].position;
    }
    means[b] /= static_cast<double>(starts[b + 1] - starts[b]);
  }
  std::vector<PatchSpan> sections;
  std::size_t begin = patch.begin;
  double angle = 0.0;
  double least = 0.0;
  double most = 0.0;
  for (std::size_t b = 2; b < blocks; ++b) {
    const Vec2 before = means[b - 1] - means[b - 2];
    const Vec2 after = means[b] - means[b - 1];
    angle += std::atan2(cross(before, after), before.dot(after));
    least = std::min(least, angle);
    most = std::max(most, angle);
    if (most - least > kLongestTurn && starts[b] - begin >= kFewestPoints &&
        patch.end - starts[b] >= kFewestPoints) {
      sections.push_back({begin, starts[b]});
      begin = starts[b];
      angle = least = most = 0.0;
    }
  }
  sections.push_back({begin, patch.end});
  return sections;
}

/// A section too short to be smoothed stands for itself.
void keep_points(FitData* data, const PatchSpan& section, SmoothModel* model) {
  const Vec2 first = data->points[section.begin].position;
  const Vec2 along = data->points[section.end - 1].position - first;
  const double whole = along.norm();
  const Vec2& told = data->points[section.begin].tangent;  // of a touch alone
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
    ++model->points;  // a direction measured, and as many parameters to take it
    ++model->parameters;
  }
}

/// The chord frame of a section: abscissa in [-1, 1] from end to end.
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

  /// Two degrees more than describe the arc: what is not yet significant in one patch may tell
  /// classes apart in several.
  int reduced_degree() const { return std::min(degree + 2, polynomials.degree()); }
};

std::optional<SectionFit> fit_section(const FitData& data, const PatchSpan& section,
                                      bool sigma_known) {
  const std::span<const FitPoint> points(data.points.data() + section.begin, section.size());
  const std::size_t n = points.size();
  if (n < kFewestPoints) {
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

  // A first pass for the slopes: they turn residuals across the chord into distances.
  constexpr int kSlopeDegree = 3;
  const OrthogonalPolynomials first(x, w, y, std::min(kSlopeDegree, highest));
  for (std::size_t i = 0; i < n; ++i) {
    const double slope = first.evaluate(x[i], first.degree()).derivative / frame.half_length;
    w[i] /= 1.0 + slope * slope;
  }
  SectionFit fit{section, frame, OrthogonalPolynomials(x, w, y, highest), 1};
  double best = std::numeric_limits<double>::infinity();
  const double count = static_cast<double>(n);
  for (int d = 1; d <= highest; ++d) {
    const double chi2 =
        std::max(fit.polynomials.residual_sum(d), std::numeric_limits<double>::min());
    const double criterion =
        (sigma_known ? chi2 : count * std::log(chi2)) + (d + 1) * std::log(count);
    if (criterion < best) {
      best = criterion;
      fit.degree = d;
    }
  }
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
  // No node says more than all samples together: where the polynomial is steeper than the slopes
  // that weighed them, it says nothing of the noise.
  double information = 0.0;
  for (std::size_t i = fit.section.begin; i < fit.section.end; ++i) {
    information += data->points[i].inverse_sigma * data->points[i].inverse_sigma;
  }
  model->sections.push_back({begin, begin + rule.size(), fit.frame.middle, fit.frame.axis,
                             fit.frame.half_length, false, false});
  for (const auto& node : rule) {
    const auto value = polynomials.evaluate(node.x, degree);
    const double slope = value.derivative / fit.frame.half_length;
    // The direction, along which a tip is taken off, by what is significant: two degrees more swing
    // with the noise.
    const double along = polynomials.evaluate(node.x, fit.degree).derivative;
    model->reduced.points.push_back(
        {fit.frame.at(node.x, value.value), fit.frame.tangent(along),
         std::sqrt(std::min(node.weight * (1.0 + slope * slope), information)), offset});
    if (offset > 0.0) {
      // Of the higher degree: what the criterion leaves out sways the direction by less.
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

/// A section as it will stand: its polynomial, or its samples where there is none.
struct Section {
  PatchSpan points;
  std::optional<SectionFit> fit;

  double chi2() const { return fit->polynomials.residual_sum(fit->reduced_degree()); }
  int dof() const { return fit ? static_cast<int>(points.size()) - fit->reduced_degree() - 1 : 0; }
};

/// Smooths a section, or its halves where even a high degree does not follow it (a sharp bend).
void smooth_section(const FitData& data, const PatchSpan& points, bool sigma_known,
                    std::vector<Section>* sections) {
  auto whole = fit_section(data, points, sigma_known);
  constexpr int kHighDegree = OrthogonalPolynomials::kMaxDegree - 2;
  if (whole && whole->degree >= kHighDegree && points.size() >= 4 * kFewestPoints) {
    const std::size_t middle = points.begin + points.size() / 2;
    smooth_section(data, {points.begin, middle}, sigma_known, sections);
    smooth_section(data, {middle, points.end}, sigma_known, sections);
    return;
  }
  sections->push_back({points, std::move(whole)});
}

/// The variance, in units of the stated one, that the quieter sections show: the lower quartile,
/// each counted by its degrees of freedom. Neither a few sections that are not followed raise it
/// nor noise that is stated too low.
double quiet_variance(const std::vector<Section>& sections) {
  std::vector<std::pair<double, int>> ratios;
  int whole = 0;
  for (const Section& section : sections) {
    if (section.dof() > 0) {
      ratios.emplace_back(section.chi2() / section.dof(), section.dof());
      whole += section.dof();
    }
  }
  std::sort(ratios.begin(), ratios.end());
  int below = 0;
  for (const auto& [ratio, dof] : ratios) {
    below += dof;
    if (4 * below >= whole) {
      return ratio;
    }
  }
  return 1.0;
}

/// Whether a section's residuals are larger than the noise can be: no polynomial follows a bend
/// that only some of its samples see. Chi-square exceeds dof + 2 sqrt(dof x) + 2 x with probability
/// exp(-x) at most (B. Laurent and P. Massart, 2000, lemma 1): by chance fewer than one section in
/// a million, which then costs time alone.
bool is_not_followed(const Section& section, double variance) {
  const int dof = section.dof();
  return dof > 0 && section.chi2() > variance * (dof + 2.0 * std::sqrt(dof * kNegligibleLogOdds) +
                                                 2.0 * kNegligibleLogOdds);
}

void cut_until_followed(const FitData& data, Section section, bool sigma_known, double variance,
                        std::vector<Section>* sections) {
  const PatchSpan points = section.points;
  if (!is_not_followed(section, variance)) {
    sections->push_back(std::move(section));
    return;
  }
  if (points.size() < 2 * kFewestPoints) {
    sections->push_back({points, std::nullopt});
    return;
  }
  const std::size_t middle = points.begin + points.size() / 2;
  for (const PatchSpan& half : {PatchSpan{points.begin, middle}, PatchSpan{middle, points.end}}) {
    cut_until_followed(data, {half, fit_section(data, half, sigma_known)}, sigma_known, variance,
                       sections);
  }
}

/// The sections, those that are not followed cut into halves until what remains is, or is too short
/// to be smoothed.
std::vector<Section> followed(const FitData& data, std::vector<Section> sections, bool sigma_known,
                              double variance) {
  if (std::none_of(sections.begin(), sections.end(),
                   [&](const Section& section) { return is_not_followed(section, variance); })) {
    return sections;
  }
  std::vector<Section> result;
  for (Section& section : sections) {
    cut_until_followed(data, std::move(section), sigma_known, variance, &result);
  }
  return result;
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
  std::vector<Section> sections;
  for (const PatchSpan& patch : data->patches) {
    if (patch.size() == 0) {
      continue;  // every sample was set aside
    }
    for (const PatchSpan& points : sections_of(*data, patch)) {
      smooth_section(*data, points, sigma_known, &sections);
    }
  }
  const double quiet = quiet_variance(sections);
  sections =
      followed(*data, std::move(sections), sigma_known, sigma_known ? std::max(quiet, 1.0) : quiet);

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
