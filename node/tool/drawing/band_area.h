// The area of a curve's band, as polygons to fill.
#pragma once

#include <vector>

#include "node/tool/drawing/drawing.h"

namespace palpate {

/// One polygon between the borders. Where a band is wider than the curve's radius, a border turns
/// back, and what lies between the borders is no longer what lies beside the curve: then a polygon
/// for every step along it, which overlap. Empty without a band.
std::vector<std::vector<Vec2>> band_area(const DrawnCurve& curve);

}  // namespace palpate
