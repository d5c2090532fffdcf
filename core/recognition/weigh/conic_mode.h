// Conics whose likelihood has no optimum that a probe could have touched.
#pragma once

#include "core/recognition/weigh/contenders.h"

namespace palpate {

/// If patches are short compared with their noise, the noise determines their curvature: the best
/// conic may be a needle, or bend the wrong way, though a plain ellipse fits nearly as well. That
/// does not exclude the class. If neither ellipse nor hyperbola has an optimum and the points are
/// not straight, this uses the mode of the ellipse's posterior instead. It starts from the circle,
/// with the axis in several directions. If no mode comes near, it sets Contenders::no_conic; if
/// that is set already, it does nothing. `classes`: wanted classes, by bit 1 << CurveClass.
Contenders with_conic_mode(Contenders contenders, const EvidenceContext& context, unsigned classes);

}  // namespace palpate
