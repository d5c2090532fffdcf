#include "core/recognition/weigh/probable_cusp.h"

#include <optional>
#include <utility>

#include "core/recognition/fit/canonical_fit.h"
#include "core/recognition/fit/on_all_points.h"
#include "core/recognition/modes/class_evidence.h"

namespace palpate {
namespace {

/// log of the evidence of a fit at its optimum; nullopt where there is none.
std::optional<double> log_evidence_at(const ClassFit& fit, const FitData& points, double inflation,
                                      WorkBudget& work) {
  const auto canonical = to_canonical(fit, points);
  const auto evidence = canonical ? evidence_of(*canonical, points, inflation, work) : std::nullopt;
  return evidence ? std::optional(evidence->log_occam - 0.5 * fit.chi2 / inflation) : std::nullopt;
}

}  // namespace

ClassFits with_probable_cusp(ClassFits fits, const FitData& reduced, double inflation,
                             WorkBudget& work) {
  auto& cusp = fits[CurveClass::SemiCubicalParabola];
  if (!cusp || !cusp->rival) {
    return fits;
  }
  const FitData& points = points_of(*cusp, reduced);
  const auto settled_from = [&](PolynomialFit polynomial) {
    ClassFit fit = *cusp;
    fit.rival.reset();
    fit.chi2 = polynomial.chi2;
    fit.polynomial = std::move(polynomial);
    return settled(fit, points, RivalOf::Other, work);
  };
  ClassFit best = settled_from(*cusp->polynomial);
  ClassFit other = settled_from(*cusp->rival);
  const auto of_best = log_evidence_at(best, points, inflation, work);
  const auto of_other = log_evidence_at(other, points, inflation, work);
  cusp = of_other && (!of_best || *of_other > *of_best) ? std::move(other) : std::move(best);
  return fits;
}

}  // namespace palpate
