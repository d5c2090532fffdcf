// Section 6 with a simulated sensor: shapes from noisy strokes, by the paper's own method and by
// the defaults.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/curves/curve_class.h"

namespace palpate::paper {

/// One way to recover the shape, over the trials in which it gave one.
struct Recovered {
  int answers = 0;
  double min[3] = {};  ///< of the shape parameters
  double max[3] = {};
  double median[3] = {};
  double spread[3] =
      {};  ///< half of what the middle 68 % span: of a normal law one standard deviation
};

struct SensorExperiment {
  int trials = 0;
  CurveClass curve_class = CurveClass::Unclassified;
  double truth[3] = {};
  Recovered by_paper;     ///< two-round estimates (n = 75, l = 4, m = 10), one a stroke, its
                          ///< invariants solved
  Recovered by_defaults;  ///< the recognizer on all samples; its hypothesis of the class
  int recognised = 0;     ///< as the class, with certainty, by the defaults
  double bound[3] = {};   ///< Kanatani-Cramer-Rao, one standard deviation, at the truth
};

/// A part of the paper's, and strokes of 111 samples, 0.2 mm apart, along it, in metres.
struct SensorPart {
  CurveClass curve_class = CurveClass::Unclassified;
  Eigen::Vector3d shape;
  /// Middles of the strokes (curve parameters): those of the table's experiment, then one more, for
  /// the tree takes one more point than the shape.
  std::vector<double> centres;
  double stroke_m = 0.0;
  double sigma_m = 0.0;
};
SensorPart table4_part();
SensorPart table5_part();

/// Table 4: the ellipse of 25 x 17.5 mm. Sigma 0.05 mm, two strokes. In mm.
SensorExperiment table4();

/// Table 5: the cubic spline segment of figure 10 (d), three strokes along it. In cm, as printed.
SensorExperiment table5();

}  // namespace palpate::paper
