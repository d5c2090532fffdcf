#include "core/recognition/smooth/followed_sections.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/numerics/probability/negligible.h"
#include "core/recognition/smooth/turning_sections.h"
#include "core/recognition/smooth/variance_ratio.h"

namespace palpate {
namespace {

/// The noise that sections are held against.
struct ReferenceNoise {
  double variance = 1.0;                                 ///< in units of the stated one
  double dof = std::numeric_limits<double>::infinity();  ///< it rests on; infinite = stated
  double time = 1.0;                                     ///< so many neighbours err together
};

/// True if chi2 is larger than noise of this variance can make it. For white noise chi-square
/// exceeds dof + 2 sqrt(dof x) + 2 x with probability exp(-x) at most (B. Laurent and P. Massart,
/// 2000, lemma 1). Where neighbours err together, chi2 / time is that of dof / time samples.
///
/// A variance that rests on residuals may itself be too low by chance.
bool is_no_noise(double chi2, int dof, const ReferenceNoise& noise) {
  const double x = noise.time * kNegligibleLogOdds;
  if (dof <= 0 || !(chi2 > noise.variance * (dof + 2.0 * std::sqrt(dof * x) + 2.0 * x))) {
    return false;
  }
  return std::isinf(noise.dof) || is_ratio_beyond_chance(chi2 / (noise.variance * dof),
                                                         dof / noise.time, noise.dof / noise.time);
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
  ReferenceNoise noise;
  /// The noise is stated, or sections with degrees to spare show it: the others may do without a
  /// polynomial.
  bool shown_elsewhere = true;
};

/// True if the polynomial does not follow a section: it leaves more than noise, because only some
/// of its samples lie in a bend (by chance this happens to fewer than one section in a million, and
/// then costs only time), or its samples are no graph over their chord, or too few for the two
/// degrees more that reduced points need, so that it may swing between them (next to a cusp). Where
/// no section shows the noise, what a graph leaves of too few is it, unless they are so few that
/// its halves would have no polynomial: what a quadratic or cubic leaves of eight samples is form
/// more often than noise.
bool is_not_followed(const Section& section, const Yardstick& yardstick) {
  const int dof = section.dof();
  return dof > 0 && (!section.fit->is_graph || is_no_noise(section.chi2(), dof, yardstick.noise) ||
                     (section.fit->lacks_degrees() &&
                      (yardstick.shown_elsewhere || section.points.size() < 2 * kFewestOfSection)));
}

/// True if most degrees of freedom are those of graphs that have degrees to spare.
bool mostly_with_degrees(const std::vector<Section>& sections) {
  int with = 0;
  int lacking = 0;
  for (const Section& section : sections) {
    if (section.fit) {
      (section.fit->is_graph && !section.fit->lacks_degrees() ? with : lacking) += section.dof();
    }
  }
  return with > lacking;
}

void cut_until_followed(const FitData& data, Section section, const SectionNoise& noise,
                        const Yardstick& yardstick, std::vector<Section>* sections) {
  const PatchSpan points = section.points;
  if (!is_not_followed(section, yardstick)) {
    sections->push_back(std::move(section));
    return;
  }
  if (points.size() < 2 * kFewestOfSection) {
    sections->push_back({points, std::nullopt, true, section.fitted});
    return;
  }
  const std::size_t middle = points.begin + points.size() / 2;
  const std::size_t first = sections->size();
  for (const PatchSpan& half : {PatchSpan{points.begin, middle}, PatchSpan{middle, points.end}}) {
    cut_until_followed(data, {half, fit_section(data, half, noise), true, half.size()}, noise,
                       yardstick, sections);
  }
  (*sections)[first].fitted += section.fitted;
}

/// Halves the sections that are not followed until all are followed or too short for a polynomial.
std::vector<Section> followed(const FitData& data, std::vector<Section> sections,
                              const SectionNoise& noise, const Yardstick& yardstick) {
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

int degrees_of(const std::vector<Section>& sections) {
  int dof = 0;
  for (const Section& section : sections) {
    dof += section.dof();
  }
  return dof;
}

std::size_t fitted_points(const std::vector<Section>& sections) {
  std::size_t count = 0;
  for (const Section& section : sections) {
    count += section.fitted;
  }
  return count;
}

}  // namespace

FollowedSections followed_sections(const FitData& data, SectionNoise noise, StatedNoise stated,
                                   const SectionSource& source) {
  FollowedSections result{sections_of_patches(data, noise, source)};
  QuietSections quiet = quiet_of(result.sections, noise.known);
  if (noise.known && stated == StatedNoise::Holds) {
    quiet.highest = 1.0;
  } else if (noise.known && is_no_noise(quiet.chi2, quiet.dof, {.time = noise.time})) {
    // The stated noise is too low everywhere: with it, the fits would follow the noise itself.
    noise.variance = quiet.chi2 / quiet.dof;
    result.fitted = fitted_points(result.sections);
    result.sections = sections_of_patches(data, noise);
    quiet = quiet_of(result.sections, noise.known);
  }
  ReferenceNoise shown{.time = noise.time};
  if (!noise.known || quiet.highest > 1.0) {
    shown.variance = quiet.highest;
    shown.dof = quiet.dof;
  }
  const Yardstick yardstick{shown, noise.known || mostly_with_degrees(result.sections)};
  result.sections = followed(data, std::move(result.sections), noise, yardstick);
  if (!noise.known && degrees_of(result.sections) < kDegreesThatShowNoise) {
    for (Section& section : result.sections) {
      section.fit.reset();
    }
  }
  result.fitted += fitted_points(result.sections);
  return result;
}

}  // namespace palpate
