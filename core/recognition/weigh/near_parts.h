// "Unclassified" as parts that are near a curve of some class.
#pragma once

#include "core/recognition/weigh/contenders.h"

namespace palpate {

/// Adds to the evidence of "unclassified" that of parts near a curve of a class (core/README.md,
/// "The posterior"). Of touches that lie apart, about the curve of any class: free paths, without
/// strokes to follow, take them for random places, and only a class could then explain that they
/// lie on anything smooth. Of strokes, smooth deviations from the best class: a free path pays for
/// every bend anew, and so has next to nothing about a part that is of a class but for a little.
/// `of_strokes`, `log_with_gross`: as WeighOptions::near_parts and log_near_with_gross. Nothing if
/// no such part can matter. `margin`: log odds below which the best class is not RECOGNIZED.
Contenders with_near_parts(Contenders contenders, const EvidenceContext& context, bool of_strokes,
                           double log_with_gross, double margin);

}  // namespace palpate
