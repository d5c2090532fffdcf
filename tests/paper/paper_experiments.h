// The paper's noise-free simulations (section 5): tables 1 to 3 and the shapes of figure 7. The
// paper does not print its step of differences, its points or its ranges of parameters; ours are
// below.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/recognition/tree/recognition_tree.h"
#include "tests/support/canonical_points.h"

namespace palpate::paper {

/// Chord length of (51) as a fraction of the local size of the curve (finite_differences.h), chosen
/// so that the errors of each class come out as large as the printed ones.
double step_of(CurveClass curve_class);

enum class Measurement { FiniteDifferences, Exact };

struct Statistics {
  double min = 0.0;
  double max = 0.0;
  double mean = 0.0;
  double stdev = 0.0;
};

Statistics statistics_of(const std::vector<double>& values);

/// One column of table 1: an invariant over 100 random points or pairs of one curve.
struct InvariantColumn {
  std::string_view name;
  double real;  ///< of our curve
  Statistics ours;
  double paper_real;  ///< as printed
  Statistics paper;   ///< as printed; stdev not given
};

std::vector<InvariantColumn> table1(Measurement measurement = Measurement::FiniteDifferences);

/// One cell of table 2: an invariant of one class on 100 random points of a curve of another.
struct WrongInvariant {
  std::string_view invariant;
  std::string_view data;
  Statistics ours;
  Statistics paper;
};

std::vector<WrongInvariant> table2(Measurement measurement = Measurement::FiniteDifferences);

/// A class of table 3, and what the paper prints of it [%].
struct Table3Class {
  std::string_view name;
  CurveClass curve_class;
  int curves;
  Statistics paper;
};
std::span<const Table3Class> table3_classes();

/// One column of table 3: relative error of the recovered parameters over random curves, in
/// percent.
struct RecoveryColumn {
  std::string_view name;
  int curves;
  Statistics ours;
  Statistics paper;
};

std::vector<RecoveryColumn> table3(Measurement measurement = Measurement::FiniteDifferences);

/// One shape of figure 7, recognised by the tree with a plain relative tolerance.
struct FigureShape {
  std::string_view name;
  CurveClass curve_class;
  Eigen::Vector3d real;   ///< (a, b), (a, c) or (a, b, c)
  Eigen::Vector3d paper;  ///< as printed: recovered; the first test's values where there are
                          ///< several, zero where the paper prints none
  TreeResult ours;
};

std::vector<FigureShape> figure7(Measurement measurement = Measurement::FiniteDifferences);

/// Figure 7 (a) at the printed t = 0.36, 1.86, 4.23: Ic1 of the three pairs and Ip of two points.
struct FigureEllipse {
  std::array<double, 3> ic1;
  std::array<double, 2> ip;
};

FigureEllipse figure7_ellipse(Measurement measurement = Measurement::FiniteDifferences);

}  // namespace palpate::paper
