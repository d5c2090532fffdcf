#include "core/recognition/weigh/edges_of_part.h"

#include <algorithm>
#include <array>

#include "core/numerics/probability/negligible.h"

namespace palpate {
namespace {

/// Whether the points show more than one edge, and more than its arc: they speak strongly against
/// a line and a circle.
bool are_seen(const Edges& edges, const Contenders& contenders, const Likelihood& likelihood) {
  return std::ranges::all_of(
      std::array{CurveClass::Line, CurveClass::Circle}, [&](CurveClass curve_class) {
        const auto& fit = contenders.fits[curve_class];
        return !fit || likelihood.counted(fit->chi2) >
                           likelihood.counted(edges.chi2) + 2.0 * kStrongEvidence;
      });
}

}  // namespace

double reach_of_edges(const Arcs& arcs, const Likelihood& likelihood, const Evidences& of_paths) {
  const double chi2 = arcs.smooth.chi2;
  const double least = log_evidence_of_unclassified(likelihood, of_paths, chi2) - kTailOfDensity;
  double reach = 1.0;
  while (likelihood.log_evidence(chi2 + reach, 0.0, kEdgesCoordinates) > least) {
    reach *= 2.0;
  }
  return reach;
}

Contenders with_edges(Contenders contenders, const EvidenceContext& context,
                      const std::optional<Edges>& edges) {
  const Likelihood& likelihood = context.likelihood;
  if (edges && are_seen(*edges, contenders, likelihood)) {
    contenders.evidences.log_edges = likelihood.log_evidence(
        edges->chi2, log_occam_of(*edges, likelihood.inflation()), kEdgesCoordinates);
  }
  return contenders;
}

}  // namespace palpate
