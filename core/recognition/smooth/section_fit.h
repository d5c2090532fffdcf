// The polynomial of one section of a patch.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/curves/plane_curve.h"
#include "core/numerics/polynomials/orthogonal_polynomials.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

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

/// From the first point of a section to its last, which must differ.
inline ChordFrame chord_frame(const Vec2& first, const Vec2& last) {
  const Vec2 chord = last - first;
  const double length = chord.norm();
  return {0.5 * (first + last), chord / length, 0.5 * length};
}

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
  bool is_graph = true;  ///< over the chord: the samples do not turn too far for that

  /// Two degrees more than the criterion chose: terms that are not yet significant in one patch may
  /// distinguish classes when there are several patches.
  int reduced_degree() const { return std::min(degree + 2, polynomials.degree()); }
  bool lacks_degrees() const { return degree + 2 > polynomials.degree(); }

  /// Distance of a point from the path, whose value there is `path`.
  double distance(const FitPoint& point, const OrthogonalPolynomials::Value& path) const {
    const double slope = path.derivative / frame.half_length;
    return (frame.across(point.position) - path.value) / std::sqrt(1.0 + slope * slope);
  }
};

/// The noise used to choose a section's degree.
struct SectionNoise {
  bool known = true;      ///< otherwise the criterion profiles it
  double variance = 1.0;  ///< in units of the stated variance
  double time = 1.0;      ///< so many neighbours err together (residual_correlation.h)
};

/// The polynomial through the samples of `section`, its degree by the criterion of Schwarz (BIC).
/// nullopt for fewer than kFewestOfSection, and where both ends lie at one place.
std::optional<SectionFit> fit_section(const FitData& data, const PatchSpan& section,
                                      const SectionNoise& noise);

/// What the samples leave across the polynomial of one degree, as distances in units of their
/// noise.
std::vector<double> residuals_of(const FitData& data, const SectionFit& fit, int degree);

}  // namespace palpate
