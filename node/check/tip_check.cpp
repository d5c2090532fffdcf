#include "node/check/tip_check.h"

#include <algorithm>
#include <limits>
#include <map>

#include "node/files/quantity.h"

namespace palpate {
namespace {

/// The box of an object's samples, and the largest tip that they are centres of.
struct TouchedByTip {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 high = -low;
  double radius_m = 0.0;

  double extent_m() const { return (high - low).norm(); }
};

std::string metres_text(double metres) {
  const LengthUnit unit = length_unit_for(metres);
  return number(metres * unit.per_m) + " " + std::string(unit.name);
}

}  // namespace

void judge_tips(const std::string& probe, const std::vector<CheckedPatch>& patches,
                CheckedSource source, std::vector<Finding>* findings) {
  // A tip that is rolled around a part by an angle moves its centre by that angle times its radius
  // or more. Over less than this the part's normal turns by less than six degrees, which tells no
  // class: rather, the radius is in another unit. [rad]
  constexpr double kLeastTurn = 0.1;
  std::map<std::uint64_t, TouchedByTip> objects;
  for (const CheckedPatch& patch : patches) {
    TouchedByTip& touched = objects[patch.object];
    touched.radius_m = std::max(touched.radius_m, patch.tip_radius_m);
    for (const Vec2& p : patch.positions) {
      touched.low = touched.low.cwiseMin(p);
      touched.high = touched.high.cwiseMax(p);
    }
  }
  for (const auto& [object, touched] : objects) {
    const double extent_m = touched.extent_m();
    if (extent_m > 0.0 && extent_m < kLeastTurn * touched.radius_m) {
      findings->push_back({Severity::Warning, probe,
                           "centres of a tip of radius " + metres_text(touched.radius_m) +
                               " extend over " + metres_text(extent_m),
                           cure_of(source, "tip_radius_m is metres: was it millimetres?",
                                   "was the radius in millimetres? --tip-radius and tip_radius_m "
                                   "are metres whatever the unit",
                                   "is tip_radius in the unit of the points?"),
                           true});
      return;  // said once
    }
  }
}

}  // namespace palpate
