#include "tests/paper/paper_experiments.h"

#include <algorithm>
#include <cmath>

#include "core/invariants/conic_invariants.h"
#include "core/invariants/conic_parameters.h"
#include "core/invariants/cubical_parabola_invariants.h"
#include "core/invariants/parabola_invariant.h"
#include "core/invariants/semi_cubical_parabola_invariants.h"
#include "core/invariants/signature_fit/spline_least_squares.h"
#include "tests/paper/finite_differences.h"
#include "tests/paper/random_curves.h"

namespace palpate::paper {
namespace {

using test::PlacedCurve;

constexpr int kEvaluations = 100;

MeasuredGeometry measure(const PlacedCurve& curve, double t, Measurement how) {
  return finite_differences(curve, t, how == Measurement::Exact ? 0.0 : step_of(curve.curve_class));
}

/// Two points that are not alike.
std::pair<MeasuredGeometry, MeasuredGeometry> random_pair(const PlacedCurve& curve, Measurement how,
                                                          Random& random) {
  for (;;) {
    const MeasuredGeometry p = measure(curve, random_place(curve, random), how);
    const MeasuredGeometry q = measure(curve, random_place(curve, random), how);
    if (are_told_apart(curve.curve_class, p, q)) {
      return {p, q};
    }
  }
}

/// The curves of table 1, from its "real" row. Its Iscp1 = 1.8851 lies outside its own [min, max],
/// a misprint: ours is the printed mean.
const PlacedCurve kParabola = curve_of(CurveClass::Parabola, 0.5 / std::pow(0.2198, 1.5));
const PlacedCurve kCubical = curve_of(CurveClass::CubicalParabola, 6.9963, 2.6127);
const PlacedCurve kSemiCubical =
    curve_of(CurveClass::SemiCubicalParabola, std::sqrt(2.0223), 6.5107);

PlacedCurve table_conic(CurveClass curve_class, double ic1, double ic2) {
  const ConicParameters p = curve_class == CurveClass::Ellipse
                                ? ellipse_parameters(ic1, ic2, Eigen::Matrix2d::Zero())
                                : hyperbola_parameters(ic1, ic2, Eigen::Matrix2d::Zero());
  return curve_of(curve_class, p.a, p.b);
}

struct TwoInvariants {
  std::vector<double> first;
  std::vector<double> second;
};

/// Evaluations with no value (no real root, for one) are drawn again.
template <typename Evaluate>
TwoInvariants evaluate(const PlacedCurve& curve, Measurement how, Random& random,
                       Evaluate&& invariants) {
  TwoInvariants result;
  while (static_cast<int>(result.first.size()) < kEvaluations) {
    const auto [p, q] = random_pair(curve, how, random);
    double first = 0.0;
    double second = 0.0;
    if (invariants(p, q, first, second)) {
      result.first.push_back(first);
      result.second.push_back(second);
    }
  }
  return result;
}

bool conic(const MeasuredGeometry& p, const MeasuredGeometry& q, double& first, double& second) {
  MeasuredGeometry other = q;
  other.patch = 1;  // the paper tests no sign
  const ConicInvariants result = conic_invariants(p, other);
  first = result.ic1;
  second = result.ic2;
  return result.status == InvariantStatus::Ok;
}

bool cubical(const MeasuredGeometry& p, const MeasuredGeometry& q, double& first, double& second) {
  const PairSolutions result = cubical_parabola_pair(p, q);
  first = result.solutions[0].parameters[0];
  second = result.solutions[0].parameters[1];
  return result.status == InvariantStatus::Ok;
}

bool semi_cubical(const MeasuredGeometry& p, const MeasuredGeometry& q, double& first,
                  double& second) {
  const PairSolutions result = semi_cubical_parabola_pair(p, q);
  first = std::pow(result.solutions[0].parameters[0], 2);
  second = result.solutions[0].parameters[1];
  return result.status == InvariantStatus::Ok;
}

/// Parameters from as few points as the paper uses: one for the parabola, two, three for the
/// spline. False where these points give none.
bool recover(const PlacedCurve& curve, Measurement how, Random& random, Eigen::Vector3d& found) {
  found.setZero();
  if (curve.curve_class == CurveClass::CubicSpline) {
    const auto [p, q] = random_pair(curve, how, random);
    const std::array points{p, q, measure(curve, random_place(curve, random), how)};
    const SemiSignatureFit fit = fit_cubic_spline(points);
    found = fit.parameters;
    return fit.status == InvariantStatus::Ok;
  }
  const auto [p, q] = random_pair(curve, how, random);
  const Eigen::Matrix2d none = Eigen::Matrix2d::Zero();
  double first = 0.0;
  double second = 0.0;
  if (curve.curve_class == CurveClass::Parabola) {
    found[0] = parabola_parameters(parabola_invariant(p.kappa, p.kappa_s), 0.0).a;
    return true;
  }
  if (curve.curve_class == CurveClass::CubicalParabola) {
    const bool good = cubical(p, q, first, second);
    found.head<2>() << first, second;
    return good;
  }
  if (curve.curve_class == CurveClass::SemiCubicalParabola) {
    const bool good = semi_cubical(p, q, first, second);
    found.head<2>() << std::sqrt(first), second;
    return good;
  }
  if (!conic(p, q, first, second)) {
    return false;
  }
  const ConicParameters parameters = curve.curve_class == CurveClass::Ellipse
                                         ? ellipse_parameters(first, second, none)
                                         : hyperbola_parameters(first, second, none);
  found.head<2>() << parameters.a, parameters.b;
  return parameters.status == InvariantStatus::Ok;
}

double relative_error(const PlacedCurve& curve, const Eigen::Vector3d& found) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (curve.parameters[i] != 0.0) {
      sum += std::pow((found[i] - curve.parameters[i]) / curve.parameters[i], 2);
    }
  }
  return std::sqrt(sum);
}

}  // namespace

double step_of(CurveClass curve_class) {
  switch (curve_class) {
    case CurveClass::Ellipse:
      return 0.05;
    case CurveClass::Parabola:
      return 0.08;
    case CurveClass::Hyperbola:
      return 0.038;
    case CurveClass::CubicalParabola:
      return 0.035;
    case CurveClass::SemiCubicalParabola:
      return 0.014;
    default:
      return 0.05;
  }
}

Statistics statistics_of(const std::vector<double>& values) {
  Statistics result;
  result.min = *std::min_element(values.begin(), values.end());
  result.max = *std::max_element(values.begin(), values.end());
  for (const double value : values) {
    result.mean += value / static_cast<double>(values.size());
  }
  for (const double value : values) {
    result.stdev += std::pow(value - result.mean, 2) / static_cast<double>(values.size() - 1);
  }
  result.stdev = std::sqrt(result.stdev);
  return result;
}

std::vector<InvariantColumn> table1(Measurement how) {
  std::vector<InvariantColumn> table;
  Random random(1);
  std::vector<double> ip;
  for (int i = 0; i < kEvaluations; ++i) {
    const auto p = measure(kParabola, random_place(kParabola, random), how);
    ip.push_back(parabola_invariant(p.kappa, p.kappa_s));
  }
  table.push_back({"Ip (18)", 0.2198, statistics_of(ip), 0.2198, {0.2168, 0.2230, 0.2198, 0.0}});
  const auto ellipse =
      evaluate(table_conic(CurveClass::Ellipse, 0.1857, 1.2055), how, random, conic);
  const auto hyperbola =
      evaluate(table_conic(CurveClass::Hyperbola, -0.2678, 0.3222), how, random, conic);
  table.push_back({"Ic1 (26) ellipse",
                   0.1857,
                   statistics_of(ellipse.first),
                   0.1857,
                   {0.1801, 0.1863, 0.1852, 0.0}});
  table.push_back({"Ic1 (26) hyperbola",
                   -0.2678,
                   statistics_of(hyperbola.first),
                   -0.2678,
                   {-0.2729, -0.2655, -0.2675, 0.0}});
  table.push_back({"Ic2 (28) ellipse",
                   1.2055,
                   statistics_of(ellipse.second),
                   1.2055,
                   {1.1749, 1.2083, 1.2035, 0.0}});
  table.push_back({"Ic2 (28) hyperbola",
                   0.3222,
                   statistics_of(hyperbola.second),
                   0.3222,
                   {0.2937, 0.3615, 0.3210, 0.0}});
  const auto cubical_values = evaluate(kCubical, how, random, cubical);
  table.push_back({"Icp1 (39)",
                   6.9963,
                   statistics_of(cubical_values.first),
                   6.9963,
                   {6.7687, 7.0289, 6.9355, 0.0}});
  table.push_back({"Icp2 (40)",
                   2.6127,
                   statistics_of(cubical_values.second),
                   2.6127,
                   {1.7312, 3.1684, 2.5022, 0.0}});
  const auto semi_values = evaluate(kSemiCubical, how, random, semi_cubical);
  table.push_back({"Iscp1 (43)",
                   2.0223,
                   statistics_of(semi_values.first),
                   1.8851,
                   {1.9912, 2.0871, 2.0223, 0.0}});
  table.push_back({"Iscp2 (44)",
                   6.5107,
                   statistics_of(semi_values.second),
                   6.5107,
                   {6.3945, 6.5834, 6.5154, 0.0}});
  return table;
}

std::vector<WrongInvariant> table2(Measurement how) {
  Random random(2);
  const PlacedCurve ellipse = curve_of(CurveClass::Ellipse, 2.8605, 1.7263);
  const PlacedCurve cubical_curve = curve_of(CurveClass::CubicalParabola, 3.2543, -2.3215);
  const PlacedCurve semi_curve = curve_of(CurveClass::SemiCubicalParabola, 2.5683, 1.4102);
  const PlacedCurve spline = curve_of(CurveClass::CubicSpline, 2.76866, -1.26705, -2.32763);
  const auto first = [&](const PlacedCurve& curve, auto invariants) {
    return statistics_of(evaluate(curve, how, random, invariants).first);
  };
  const auto second = [&](const PlacedCurve& curve, auto invariants) {
    return statistics_of(evaluate(curve, how, random, invariants).second);
  };
  return {
      {"Ic1", "cubical parabola", first(cubical_curve, conic), {-6.38, -0.04, -0.73, 1.22}},
      {"Ic1", "semi-cubical parabola", first(semi_curve, conic), {-22.84, 28.37, 3.37, 6.76}},
      {"Ic1", "cubic spline", first(spline, conic), {-45.24, -4.94, -16.50, 10.86}},
      {"Icp2", "ellipse", second(ellipse, cubical), {-11.97, -15.46, -0.04, 2.53}},
      {"Icp2", "semi-cubical parabola", second(semi_curve, cubical), {8.54, 19.03, 13.76, 3.07}},
      {"Icp2", "cubic spline", second(spline, cubical), {11.66, 1721.04, 55.52, 217.34}},
      {"Iscp2", "ellipse", second(ellipse, semi_cubical), {-265.80, 5.83, -3.22, 26.75}},
      {"Iscp2",
       "cubical parabola",
       second(cubical_curve, semi_cubical),
       {7.80, 65.22, 29.17, 17.19}},
      {"Iscp2", "cubic spline", second(spline, semi_cubical), {-150.68, 1715.73, 38.97, 182.24}},
  };
}

std::span<const Table3Class> table3_classes() {
  static constexpr std::array kRows = {
      Table3Class{"ellipse", CurveClass::Ellipse, 100, {0.02, 7.99, 0.40, 0.0}},
      Table3Class{"hyperbola", CurveClass::Hyperbola, 100, {0.10, 9.71, 1.15, 0.0}},
      Table3Class{"parabola", CurveClass::Parabola, 100, {0.01, 3.35, 0.36, 0.0}},
      Table3Class{"cubical parabola", CurveClass::CubicalParabola, 100, {0.02, 7.49, 0.83, 0.0}},
      Table3Class{
          "semi-cubical parabola", CurveClass::SemiCubicalParabola, 100, {0.04, 8.09, 1.23, 0.0}},
      Table3Class{"cubic spline", CurveClass::CubicSpline, 25, {1.57, 10.22, 5.68, 0.0}}};
  return kRows;
}

std::vector<RecoveryColumn> table3(Measurement how) {
  std::vector<RecoveryColumn> table;
  std::uint64_t stream = 30;
  for (const Table3Class& row : table3_classes()) {
    Random random(stream++);
    std::vector<double> errors;
    while (static_cast<int>(errors.size()) < row.curves) {
      const PlacedCurve curve = random_curve(row.curve_class, random);
      Eigen::Vector3d found;
      if (recover(curve, how, random, found)) {
        errors.push_back(100.0 * relative_error(curve, found));
      }
    }
    table.push_back({row.name, row.curves, statistics_of(errors), row.paper});
  }
  return table;
}

std::vector<FigureShape> figure7(Measurement how) {
  struct Shape {
    std::string_view name;
    PlacedCurve curve;
    Eigen::Vector3d paper;
    std::vector<double> places;
  };
  // The paper prints the places of (a) only.
  const std::vector<Shape> shapes = {
      {"(a) ellipse",
       curve_of(CurveClass::Ellipse, 2.8605, 1.7263),
       {2.8609, 1.7275, 0.0},
       {0.36, 1.86, 4.23}},
      {"(b) cubical parabola",
       curve_of(CurveClass::CubicalParabola, 3.2543, -2.3215),
       {3.2244, -2.3237, 0.0},
       {0.3, 0.55, -0.75}},
      {"(c) semi-cubical parabola",
       curve_of(CurveClass::SemiCubicalParabola, 2.5683, 1.4102),
       Eigen::Vector3d::Zero(),
       {0.5, 0.9, -0.6}},
      {"(d) cubic spline",
       curve_of(CurveClass::CubicSpline, 2.76866, -1.26705, -2.32763),
       {2.77468, -1.30929, -2.3081},
       {0.35, 0.8, -0.5, -0.9}}};
  RecognitionTreeOptions options;
  options.relative_tolerance = 0.05;
  std::vector<FigureShape> figure;
  for (const Shape& shape : shapes) {
    std::vector<TreePoint> points;
    for (const double t : shape.places) {
      const MeasuredGeometry measured = measure(shape.curve, t, how);
      TreePoint point;
      point.estimate = test::exact_estimate(shape.curve, t);
      point.estimate.kappa = measured.kappa;
      point.estimate.kappa_s = measured.kappa_s;
      point.patch = static_cast<int>(points.size());
      points.push_back(point);
    }
    figure.push_back({shape.name, shape.curve.curve_class, shape.curve.parameters, shape.paper,
                      recognise_by_tree(points, options)});
  }
  return figure;
}

FigureEllipse figure7_ellipse(Measurement how) {
  const PlacedCurve curve = curve_of(CurveClass::Ellipse, 2.8605, 1.7263);
  const std::array points{measure(curve, 0.36, how), measure(curve, 1.86, how),
                          measure(curve, 4.23, how)};
  return {{conic_invariants(points[0], points[1]).ic1, conic_invariants(points[0], points[2]).ic1,
           conic_invariants(points[1], points[2]).ic1},
          {parabola_invariant(points[0].kappa, points[0].kappa_s),
           parabola_invariant(points[1].kappa, points[1].kappa_s)}};
}

}  // namespace palpate::paper
