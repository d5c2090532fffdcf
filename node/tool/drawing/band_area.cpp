#include "node/tool/drawing/band_area.h"

#include <cstddef>

namespace palpate {
namespace {

struct Borders {
  std::vector<Vec2> left;
  std::vector<Vec2> right;
};

bool turns_back(const std::vector<Vec2>& border, const std::vector<CurvePlace>& places) {
  for (std::size_t i = 1; i < border.size(); ++i) {
    const Vec2 step = places[i].position - places[i - 1].position;
    if ((border[i] - border[i - 1]).dot(step) < 0.0) return true;
  }
  return false;
}

}  // namespace

std::vector<std::vector<Vec2>> band_area(const DrawnCurve& curve) {
  Borders borders;
  for (const CurvePlace& place : curve.places) {
    if (!place.band) return {};
    borders.left.push_back(place.position + place.band->left_m * place.left);
    borders.right.push_back(place.position + place.band->right_m * place.left);
  }
  if (!turns_back(borders.left, curve.places) && !turns_back(borders.right, curve.places)) {
    std::vector<Vec2> whole = borders.left;
    whole.insert(whole.end(), borders.right.rbegin(), borders.right.rend());
    return {whole};
  }
  std::vector<std::vector<Vec2>> pieces;
  for (std::size_t i = 1; i < curve.places.size(); ++i) {
    // On either side of the curve on its own: a side that turns back crosses itself.
    for (const std::vector<Vec2>* border : {&borders.left, &borders.right}) {
      pieces.push_back(
          {curve.places[i - 1].position, curve.places[i].position, (*border)[i], (*border)[i - 1]});
    }
  }
  return pieces;
}

}  // namespace palpate
