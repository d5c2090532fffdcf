// The share of each class's prior in curves that are nearly straight.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>

#include "core/recognition/modes/class_evidence.h"
#include "core/recognition/posterior/likelihood.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// What the points show of a path compared with the best straight line: its curvature and the rate
/// of curvature along the arc. Both are taken at the place near the middle where the points
/// determine them independently. In half extents.
struct BendOfLine {
  double curvature_sigma = 0.0;
  double rate_sigma = 0.0;
  /// The maximum of the likelihood, in units of these standard deviations.
  double curvature = 0.0;
  double rate = 0.0;
  /// For unknown noise: chi-square there after form error, and its degrees of freedom beyond the
  /// line.
  double chi2 = 1.0;
  double freedom = std::numeric_limits<double>::infinity();

  /// By how much chi-square, as it counts, is less there than on the line.
  double fall() const { return curvature * curvature + rate * rate; }
};

/// The likelihood of y = offset + turn x + curvature x^2 / 2 + rate x^3 / 6, with offset and turn
/// integrated out; exact if slopes are small. `line`: the evidence of a line on the same data;
/// `chi2`: its chi-square there. nullopt if there are too few points, if points have normals, or if
/// the points show a bend that excludes the line. O(points).
std::optional<BendOfLine> bend_of_line(const ClassEvidence& line, double chi2, const FitData& data,
                                       const Likelihood& likelihood);

/// log of (evidence of a class in nearly straight paths / evidence of the line): the mean of the
/// likelihood ratio over the class's prior. Accurate to a tenth. For every class except line and
/// Unclassified.
double log_evidence_over_line(CurveClass curve_class, const BendOfLine& bend);

}  // namespace palpate
