// "Unclassified" as two edges with a fillet.
#pragma once

#include "core/recognition/weigh/contenders.h"

namespace palpate {

/// Adds to the evidence of "unclassified" that of two straight edges with a fillet (core/README.md,
/// "The posterior"): a free path pays for a corner with every bend that it makes there, and a
/// hyperbola or spline with a vertex as tight would be certain. Nothing if no such edges can
/// matter. `margin`: log odds below which the best class is not RECOGNIZED.
Contenders with_edges(Contenders contenders, const EvidenceContext& context, double margin);

}  // namespace palpate
