#include "tests/paper/figure_invariants.h"

#include <cmath>

#include "core/invariants/conic_invariants.h"
#include "core/invariants/parabola_invariant.h"

namespace palpate::paper {
namespace {

MeasuredGeometry measured_at(const Curve& curve, double t) {
  const LocalGeometry local = geometry(curve, t);
  return {local.tangent_angle, local.kappa, local.kappa_s, Eigen::Matrix3d::Zero(), 0};
}

}  // namespace

std::vector<FigureCurve> figure4() {
  constexpr double kPlace = 0.7;  // arbitrary
  std::vector<FigureCurve> figure;
  for (const double a : {0.25, 0.5, 1.0}) {
    FigureCurve curve{Parabola{a}, {a, 0.0}, {kPlace, kPlace}, {}, {std::pow(2.0 * a, -2.0 / 3.0)}};
    const LocalGeometry local = geometry(curve.curve, kPlace);
    curve.measured[0] = parabola_invariant(local.kappa, local.kappa_s);
    figure.push_back(curve);
  }
  return figure;
}

std::vector<FigureCurve> figure5() {
  constexpr std::array kPlaces = {0.4, 1.3};  // arbitrary
  std::vector<FigureCurve> figure;
  for (const auto& [a, b] : {std::array{1.6, 0.8}, {1.3, 1.0}, {1.1, 1.1}}) {
    FigureCurve curve{Ellipse{a, b}, {a, b}, kPlaces, {}, {}};
    curve.expected = {std::pow(a * b, -2.0 / 3.0), (a * a + b * b) * std::pow(a * b, -4.0 / 3.0)};
    if (a == b) {
      curve.curve = Circle{a};
      const double kappa = geometry(curve.curve, kPlaces[0]).kappa;
      curve.measured[0] = std::pow(kappa, 4.0 / 3.0);
      curve.measured[1] =
          parabola_invariant(kappa, 0.0) + curve.measured[0] / curvature_two_thirds(kappa);
    } else {
      const ConicInvariants pair = conic_invariants(measured_at(curve.curve, kPlaces[0]),
                                                    measured_at(curve.curve, kPlaces[1]));
      curve.measured = {pair.ic1, pair.ic2};
    }
    figure.push_back(curve);
  }
  return figure;
}

}  // namespace palpate::paper
