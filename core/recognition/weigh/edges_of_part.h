// "Unclassified" as two edges with a fillet.
#pragma once

#include <optional>

#include "core/recognition/posterior/edges.h"
#include "core/recognition/weigh/contenders.h"

namespace palpate {

/// The chi-square on the reduced points, to a factor of two, above which edges add nothing to the
/// evidence of free paths.
double reach_of_edges(const Arcs& arcs, const Likelihood& likelihood, const Evidences& of_paths);

/// Adds to the evidence of "unclassified" that of two straight edges with a fillet (core/README.md,
/// "The posterior"): a free path pays for a corner with every bend that it makes there, and a
/// hyperbola or spline with a vertex as tight would be certain. Nothing if a line or a circle,
/// which are classes, is all that the points show of them.
Contenders with_edges(Contenders contenders, const EvidenceContext& context,
                      const std::optional<Edges>& edges);

}  // namespace palpate
