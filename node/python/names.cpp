#include "node/python/names.h"

#include <stdexcept>

namespace palpate {

std::vector<std::string> curve_classes() {
  std::vector<std::string> names;
  names.reserve(kCurveClasses.size());
  for (const CurveClass known : kCurveClasses) {
    names.emplace_back(name_of(known));
  }
  return names;
}

CurveClass class_called(const std::string& name) {
  const auto found = curve_class_from_name(name);
  if (found && *found != CurveClass::Unclassified) return *found;
  std::string known;
  for (const std::string& one : curve_classes()) known += (known.empty() ? "" : ", ") + one;
  throw std::invalid_argument("\"" + name + "\" is no curve class: " + known);
}

TouchedFrom place_called(const std::string& name) {
  if (const auto place = touched_from_from_name(name)) return *place;
  throw std::invalid_argument("touched_from: \"" + name + "\" is none of outside, inside, unknown");
}

MaterialSide side_called(const std::string& name) {
  if (const auto side = material_side_from_name(name)) return *side;
  throw std::invalid_argument("material_side: \"" + name +
                              "\" is none of left, right, unspecified");
}

}  // namespace palpate
