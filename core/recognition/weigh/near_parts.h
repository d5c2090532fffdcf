// Touches that lie apart: "unclassified" as parts that are near a curve of some class.
#pragma once

#include "core/recognition/weigh/contenders.h"

namespace palpate {

/// Adds to the evidence of "unclassified" that of smooth parts near a curve of a class
/// (core/README.md, "The posterior"). Free paths, without strokes to follow, take touches for
/// random places: only a class could then explain that they lie on anything smooth. Nothing if
/// there are strokes, or if no such part can matter. `margin`: log odds below which the best class
/// is not RECOGNIZED.
Contenders with_near_parts(Contenders contenders, const EvidenceContext& context, double margin);

}  // namespace palpate
