// What the contact points say without any curve class: each patch a smooth arc of its own.
#pragma once

#include <cstdint>
#include <vector>

#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// The reduced points of one section and the chord frame that they were smoothed in.
struct ReducedSection {
  std::size_t begin = 0;  ///< of the reduced points
  std::size_t end = 0;
  Vec2 middle = Vec2::Zero();
  Vec2 axis = Vec2::UnitX();
  double half_length = 0.0;
  bool joined = false;  ///< continues the section before it, in the same patch
  bool kept = false;    ///< too short to be smoothed: its points are the samples themselves
};

/// Piecewise polynomial fit in chord frames: a yardstick for every class, and the points reduced to
/// what they say. Its residuals are noise alone, whatever the class (as long as the curve is smooth
/// on the scale of a section); a class that leaves much more behind does not fit, and one that
/// leaves no more cannot be bettered.
struct SmoothModel {
  double chi2 = 0.0;   ///< sum of squared normalised residuals
  int parameters = 0;  ///< polynomial coefficients used in all sections
  int points = 0;      ///< and measured normals
  /// The nodes of the discrete Gauss quadrature of each section, on the fitted polynomial, with the
  /// weights as inverse variances: for any curve that the section's polynomials can follow,
  ///   chi2(curve; points) = chi2(smooth model) + chi2(curve; reduced points)
  /// up to rounding (core/README.md, "Refinement and the bound"). A dozen points stand for
  /// hundreds.
  FitData reduced;
  std::vector<ReducedSection> sections;  ///< all reduced points, in their order
  /// For every point the reduced point nearest to it along its section.
  std::vector<std::uint32_t> nearest_reduced;

  int dof() const { return points - parameters; }
  /// Root mean square of the normalised residuals per degree of freedom: the noise in units of the
  /// points' stated sigma. 0 if there are no degrees of freedom.
  double noise_ratio() const;
};

/// Cuts each patch into sections that turn by less than about a radian and fits each with the
/// polynomial degree that the Bayesian information criterion chooses. With `sigma_known`,
/// chi-square is taken at its word; otherwise the criterion profiles the noise. Sets the tangents
/// of `data`. O(points).
SmoothModel fit_smooth_model(FitData* data, bool sigma_known);

/// Multiplies the noise of the data's points and of the model's reduced ones, and takes chi-square
/// along.
void scale_noise(double factor, FitData* data, SmoothModel* smooth);

}  // namespace palpate
