// What the prior of each class has of curves that are nearly straight.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>

#include "core/recognition/posterior/class_evidence.h"
#include "core/recognition/posterior/likelihood.h"
#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// What the points tell of a path beside the straight line that fits them best: of its curvature
/// and the curvature's rate along the arc in the middle of what was touched, where they tell both
/// independently. In half extents.
struct BendOfLine {
  double curvature_sigma = 0.0;
  double rate_sigma = 0.0;
  /// Where the likelihood is highest, in these deviations.
  double curvature = 0.0;
  double rate = 0.0;
  /// Where the residuals are to tell the noise: chi-square as it counts there, and how many they
  /// are beyond what the line takes.
  double chi2 = 1.0;
  double freedom = std::numeric_limits<double>::infinity();
};

/// The likelihood of y = offset + turn x + curvature x^2 / 2 + rate x^3 / 6, offset and turn
/// integrated out: exact as long as slopes are small. `line`: the evidence of a line on the same
/// data, `chi2` what it leaves there. nullopt where the points do not tell it: too few, or with
/// normals; and where they tell a bend from which nothing of the line is left. O(points).
std::optional<BendOfLine> bend_of_line(const ClassEvidence& line, double chi2, const FitData& data,
                                       const Likelihood& likelihood);

/// log of a class's evidence over the line's, as far as it lies in paths that are nearly straight:
/// the mean over its prior of their likelihood over the line's. Right to a tenth. For every class
/// but the line and Unclassified.
double log_evidence_over_line(CurveClass curve_class, const BendOfLine& bend);

}  // namespace palpate
