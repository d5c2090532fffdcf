// The contact points without any curve class: each patch as a smooth arc.
#pragma once

#include <cstdint>
#include <vector>

#include "core/recognition/samples/fit_data.h"
#include "core/recognition/smooth/followed_sections.h"
#include "core/recognition/smooth/patch_sections.h"

namespace palpate {

/// The reduced points of one section, and the chord frame of its polynomial.
struct ReducedSection {
  std::size_t begin = 0;  ///< range [begin, end) of the reduced points
  std::size_t end = 0;
  Vec2 middle = Vec2::Zero();
  Vec2 axis = Vec2::UnitX();
  double half_length = 0.0;
  bool joined = false;  ///< continues the section before it, in the same patch
  bool kept = false;    ///< no polynomial fits it: its reduced points are the samples themselves
};

/// Piecewise polynomial fit in chord frames. Its residuals are noise alone, whatever the class, if
/// the curve is smooth on the scale of a section. So it is a yardstick for every class: a class
/// with much larger residuals does not fit, and none can have smaller ones.
struct SmoothModel {
  double chi2 = 0.0;   ///< sum of squared normalised residuals
  int parameters = 0;  ///< coefficients of all polynomials, and points without one
  int points = 0;      ///< points plus measured normals
  /// The nodes of each section's discrete Gauss quadrature, on the fitted polynomial, with the
  /// weights as inverse variances. For any curve that the section's polynomials can follow, up to
  /// rounding,
  ///   chi2(curve; points) = chi2(smooth model) + chi2(curve; reduced points)
  /// (core/README.md, "Refinement and the bound"). So a dozen points stand for hundreds.
  FitData reduced;
  std::vector<ReducedSection> sections;  ///< covers all reduced points, in order
  /// For every point, the index of the nearest reduced point along its section.
  std::vector<std::uint32_t> nearest_reduced;
  /// Of so many samples of a stroke, which err together, each counts as one; 1 = white noise.
  double noise_time = 1.0;
  int coefficients = 0;    ///< of the polynomials alone
  bool is_halved = false;  ///< some sections are halves of one that no polynomial followed
  std::size_t fitted = 0;  ///< points in the fits of all sections, until this

  int dof() const { return points - parameters; }
  /// Degrees of freedom that are left to estimate the noise from: of noise that neighbours share, a
  /// coefficient takes `noise_time` of them.
  double noise_dof() const;
  /// Square root of chi-square over noise_dof(): the noise in units of the points' sigma; 0 without
  /// any.
  double noise_ratio() const;
};

/// Largest expected difference between chi-square on all points and the one inferred from the
/// reduced points, if these follow the points. A term left out of a section's polynomial adds less
/// than the logarithm of the section's samples (BIC): 4 for 55.
inline constexpr double kLeastError = 4.0;

/// Cuts each patch into sections that turn by less than about a radian and fits each by a
/// polynomial. The Bayesian information criterion chooses its degree. `sigma_known`: the points'
/// noise is known; otherwise the criterion profiles it. Where neighbours err together, as the
/// sections show, BIC counts so many fewer samples. Sets the tangents of `data`. `source`: where
/// these come from, if sections are kept from one smoothing to the next. O(points).
SmoothModel fit_smooth_model(FitData* data, bool sigma_known,
                             StatedNoise stated = StatedNoise::MayBeTooLow,
                             const SectionSource& source = {});

/// Of the variance of a stated noise, what sections leave of it at least where neighbours share it.
/// Slower noise is hardly told from a path: of noise of which neighbours correlate by 0.95 a cubic
/// over 111 samples leaves a third, and seldom less than this (residual_correlation_test).
inline constexpr double kLeastNoiseShown = 0.1;

/// The section of a point, by its index among all. O(log(sections)).
const ReducedSection& section_of(const SmoothModel& smooth, std::size_t point);

/// Whether residuals leave so little as white noise does once in a thousand times.
bool leaves_less_than_noise(double chi2, double dof);

/// Length of path over which neighbours err together, in units of the points: that of `noise_time`
/// samples at their mean distance; 0 = white noise.
double noise_length(const SmoothModel& smooth, const FitData& data);

/// Multiplies the noise of all points and reduced points by `factor`, and divides chi2 by its
/// square.
void scale_noise(double factor, FitData* data, SmoothModel* smooth);

}  // namespace palpate
