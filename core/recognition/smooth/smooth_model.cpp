#include "core/recognition/smooth/smooth_model.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>

#include "core/numerics/polynomials/orthogonal_polynomials.h"
#include "core/numerics/probability/chi_square.h"
#include "core/recognition/smooth/followed_sections.h"
#include "core/recognition/smooth/path_of_details.h"
#include "core/recognition/smooth/residual_correlation.h"

namespace palpate {
namespace {

/// Keeps the samples of a section that no polynomial fits as its reduced points, their directions
/// those of the chords between their neighbours in the patch.
void keep_points(FitData* data, const PatchSpan& patch, const PatchSpan& section,
                 SmoothModel* model) {
  const Vec2 first = data->points[section.begin].position;
  const Vec2 along = data->points[section.end - 1].position - first;
  const double whole = along.norm();
  const Vec2& told = data->points[section.begin].tangent;  // of a single touch
  const Vec2 axis = whole > 0.0 ? Vec2(along / whole) : told.isZero() ? Vec2(1.0, 0.0) : told;
  model->sections.push_back({model->reduced.points.size(),
                             model->reduced.points.size() + section.size(), first + 0.5 * along,
                             axis, whole > 0.0 ? 0.5 * whole : 1.0, false, true});
  for (std::size_t i = section.begin; i < section.end; ++i) {
    const std::size_t before = i > patch.begin ? i - 1 : i;
    const std::size_t after = i + 1 < patch.end ? i + 1 : i;
    const Vec2 chord = data->points[after].position - data->points[before].position;
    const double length = chord.norm();
    if (patch.size() > 1) {
      data->points[i].tangent = length > 0.0 ? Vec2(chord / length) : Vec2(0.0, 0.0);
    }
    if (!data->details.empty()) {
      data->details[i].travel.setZero();
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

/// `neighbours`: of the residuals of the chosen degree.
void add_smoothed(FitData* data, const SectionFit& fit, SmoothModel* model,
                  NeighbourSums* neighbours) {
  const OrthogonalPolynomials& polynomials = fit.polynomials;
  const int degree = fit.reduced_degree();
  model->chi2 += polynomials.residual_sum(degree);
  model->parameters += degree + 1;
  model->coefficients += degree + 1;
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
    FitPoint& point = data->points[i];
    const double x = fit.frame.along(point.position);
    const auto path = polynomials.evaluate(x, fit.degree);
    point.tangent = fit.frame.tangent(path.derivative);
    const double residual = fit.distance(point, path) * point.inverse_sigma;
    if (i == fit.section.begin) {
      neighbours->add_first(residual, static_cast<std::size_t>(fit.degree) + 1);
    } else {
      neighbours->add_next(residual);
    }
    std::size_t nearest = 0;
    for (std::size_t k = 1; k < rule.size(); ++k) {
      nearest = std::abs(rule[k].x - x) < std::abs(rule[nearest].x - x) ? k : nearest;
    }
    model->nearest_reduced[i] = static_cast<std::uint32_t>(begin + nearest);
  }
  if (!data->details.empty()) {
    tell_path(fit, data);
  }
}

void add_section(FitData* data, const PatchSpan& patch, const Section& section, SmoothModel* model,
                 NeighbourSums* neighbours) {
  if (section.fit) {
    add_smoothed(data, *section.fit, model, neighbours);
  } else {
    keep_points(data, patch, section.points, model);
  }
}

/// What the sections tell of neighbours that err together. Of a stated noise they may show only a
/// part, of which alone it is known that neighbours share it.
double noise_time_of(const FitData& data, const std::vector<Section>& sections, bool sigma_known) {
  std::vector<RunOfResiduals> left;
  double chi2 = 0.0;
  double samples = 0.0;
  for (const Section& section : sections) {
    if (section.fit) {
      const int degree = section.fit->reduced_degree();
      left.push_back(
          {residuals_of(data, *section.fit, degree), static_cast<std::size_t>(degree) + 1});
      chi2 += section.chi2();
      samples += static_cast<double>(section.points.size());
    }
  }
  const double time = correlation_time(left);
  const double share = sigma_known ? std::min(1.0, chi2 / (kLeastNoiseShown * samples)) : 1.0;
  constexpr double kNothing = 0.01;  // less changes no answer
  const double more = share * (time - 1.0);
  return more > kNothing ? 1.0 + more : 1.0;
}

/// The smooth model of noise of which so many neighbours err together.
SmoothModel smooth_model_of(FitData* data, const SectionNoise& noise, StatedNoise stated,
                            const SectionSource& source) {
  SmoothModel model;
  model.points = static_cast<int>(data->points.size());
  model.nearest_reduced.resize(data->points.size());
  model.reduced.frame = data->frame;
  model.reduced.scale = data->scale;
  const FollowedSections followed = followed_sections(*data, noise, stated, source);
  const std::vector<Section>& sections = followed.sections;
  model.fitted = followed.fitted;

  NeighbourSums neighbours;
  auto section = sections.begin();
  for (const PatchSpan& patch : data->patches) {
    const std::size_t begin = model.reduced.points.size();
    const auto first = section;
    for (; section != sections.end() && section->points.begin < patch.end; ++section) {
      add_section(data, patch, *section, &model, &neighbours);
      model.sections.back().joined = section != first;
    }
    model.reduced.patches.push_back({begin, model.reduced.points.size(), patch.is_joined});
  }
  model.is_halved =
      std::any_of(sections.begin(), sections.end(), [](const Section& s) { return s.is_part; });
  if (neighbours.look_alike()) {
    model.noise_time = noise_time_of(*data, sections, noise.known);
  }
  return model;
}

/// Whether the sections may have followed what neighbours share. Of a stated noise they leave less
/// then than it does once in a thousand times. Where nobody states it, polynomials do not follow it
/// for long.
bool may_follow_noise(const SmoothModel& model, bool sigma_known) {
  return sigma_known ? leaves_less_than_noise(model.chi2 / model.noise_time,
                                              model.noise_dof() / model.noise_time)
                     : model.is_halved;
}

/// The slowest noise that is told from paths: half of it would be taken by a cubic in each patch.
double slowest_noise(const FitData& data) {
  constexpr double kCoefficients = 4.0;
  return std::max(1.0, 0.5 * static_cast<double>(data.points.size()) /
                           (kCoefficients * static_cast<double>(data.patches.size())));
}

}  // namespace

const ReducedSection& section_of(const SmoothModel& smooth, std::size_t point) {
  return *std::prev(std::upper_bound(
      smooth.sections.begin(), smooth.sections.end(), smooth.nearest_reduced[point],
      [](std::uint32_t k, const ReducedSection& section) { return k < section.begin; }));
}

bool leaves_less_than_noise(double chi2, double dof) {
  constexpr double kOneInThousand = 1e-3;
  return dof >= 1.0 && chi_square_survival(chi2, static_cast<int>(dof)) > 1.0 - kOneInThousand;
}

double SmoothModel::noise_dof() const { return dof() - (noise_time - 1.0) * coefficients; }

double SmoothModel::noise_ratio() const {
  return noise_dof() > 0.0 ? std::sqrt(chi2 / noise_dof()) : 0.0;
}

SmoothModel fit_smooth_model(FitData* data, bool sigma_known, StatedNoise stated,
                             const SectionSource& source) {
  constexpr double kSame = 1.25;  // times that smooth alike: as noises do 12 % apart
  constexpr int kMostTimes = 3;   // a bound of time: the last one's sections are taken
  std::size_t fitted = 0;
  // From the noise of that time to the one that its sections show.
  const auto settled = [&](double time, FitData* smoothed) {
    SmoothModel model;
    for (int i = 0; i < kMostTimes; ++i) {
      model = smooth_model_of(smoothed, {sigma_known, 1.0, time}, stated, source);
      fitted += model.fitted;
      if (std::max(model.noise_time / time, time / model.noise_time) <= kSame) {
        break;
      }
      time = model.noise_time;
    }
    return model;
  };
  SmoothModel model = settled(1.0, data);
  // Sections that follow what neighbours share leave little of it, and that is white.
  const double slowest = slowest_noise(*data);
  if (slowest > kSame && may_follow_noise(model, sigma_known)) {
    FitData again = *data;
    SmoothModel slow = settled(slowest, &again);
    if (slow.noise_time > kSame * model.noise_time) {
      model = std::move(slow);
      *data = std::move(again);
    }
  }
  model.fitted = fitted;
  return model;
}

double noise_length(const SmoothModel& smooth, const FitData& data) {
  return smooth.noise_time > 1.0 ? smooth.noise_time * mean_step(data) : 0.0;
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
