#include "core/recognition/weigh/edges_of_part.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/recognition/posterior/edges.h"

namespace palpate {
namespace {

/// Whether the class is an edge, or a fillet's arc, and noise explains what it leaves.
bool is_one_edge_or_arc(const ClassFit& fit, const EvidenceContext& context) {
  return (fit.curve_class == CurveClass::Line || fit.curve_class == CurveClass::Circle) &&
         fits_well(fit.chi2, residual_count(context.arcs.data));
}

/// The chi-square on the reduced points above which edges have less evidence than `least`, to a
/// factor of two.
double reach_of(double least, const EvidenceContext& context) {
  double reach = 1.0;
  while (reach < context.out_of_reach &&
         context.likelihood.log_evidence(context.arcs.smooth.chi2 + reach, 0.0, kEdgesCoordinates) >
             least) {
    reach *= 2.0;
  }
  return reach;
}

/// Whether the points show more than one edge, and more than its arc: a line and a circle are
/// classes.
bool are_seen(const Edges& edges, const Contenders& contenders, const Likelihood& likelihood) {
  // log of the evidence that speaks against a line or circle: "strongly", by the scale of Kass and
  // Raftery (1995).
  constexpr double kSeen = 3.0;
  return std::ranges::all_of(
      std::array{CurveClass::Line, CurveClass::Circle}, [&](CurveClass curve_class) {
        const auto& fit = contenders.fits[curve_class];
        return !fit || likelihood.counted(fit->chi2) > likelihood.counted(edges.chi2) + 2.0 * kSeen;
      });
}

}  // namespace

Contenders with_edges(Contenders contenders, const EvidenceContext& context, double margin) {
  contenders.evidences.log_edges = kNoEvidence;
  const Likelihood& likelihood = context.likelihood;
  const CurveClass best = best_class(contenders.fits, likelihood, contenders.evidences);
  if (!contenders.fits[best] || is_one_edge_or_arc(*contenders.fits[best], context)) {
    return contenders;
  }
  const double least =
      log_evidence(likelihood, contenders.evidences, *contenders.fits[best]) - margin - kNotAsked;
  // What sections that do not follow hide of any class (refine_plausible).
  const double told = contenders.coarse[best]->chi2 + context.arcs.smooth.chi2;
  const double error = std::max(kLeastError, 2.0 * std::abs(told - contenders.fits[best]->chi2));
  const auto edges = edges_of(context.arcs, likelihood.inflation(),
                              reach_of(least, context) + error, context.work);
  if (edges && are_seen(*edges, contenders, likelihood)) {
    contenders.evidences.log_edges =
        likelihood.log_evidence(edges->chi2, edges->log_occam, kEdgesCoordinates);
  }
  return contenders;
}

}  // namespace palpate
