#include "core/curves/curve_class.h"

#include <cassert>
#include <string>

namespace palpate {
namespace {

struct ClassFacts {
  CurveClass curve_class;
  std::string_view name;
  std::string_view letters;
  int symmetry;
  int degrees_of_freedom;
};

constexpr std::array<ClassFacts, 9> kFacts = {{
    {CurveClass::Unclassified, "unclassified", "", 1, 0},
    {CurveClass::Line, "line", "", 0, 2},
    {CurveClass::Circle, "circle", "a", 0, 3},
    {CurveClass::Ellipse, "ellipse", "ab", 2, 5},
    {CurveClass::Parabola, "parabola", "a", 1, 4},
    {CurveClass::Hyperbola, "hyperbola", "ab", 1, 5},
    {CurveClass::CubicalParabola, "cubical_parabola", "ac", 2, 5},
    {CurveClass::SemiCubicalParabola, "semi_cubical_parabola", "ab", 1, 5},
    {CurveClass::CubicSpline, "cubic_spline", "abc", 1, 6},
}};

const ClassFacts& facts_of(CurveClass curve_class) {
  const auto& facts = kFacts[static_cast<std::size_t>(curve_class)];
  assert(facts.curve_class == curve_class);
  return facts;
}

}  // namespace

std::string_view name_of(CurveClass curve_class) { return facts_of(curve_class).name; }

std::string_view parameter_letters(CurveClass curve_class) { return facts_of(curve_class).letters; }

int pose_symmetry(CurveClass curve_class) { return facts_of(curve_class).symmetry; }

int degrees_of_freedom(CurveClass curve_class) { return facts_of(curve_class).degrees_of_freedom; }

std::optional<CurveClass> curve_class_from_name(std::string_view name) {
  std::string normal;
  for (const char c : name) {
    if (c == '-' || c == ' ') {
      normal += '_';
    } else {
      normal += (c >= 'A' && c <= 'Z') ? static_cast<char>(c - 'A' + 'a') : c;
    }
  }
  for (const auto& facts : kFacts) {
    if (facts.name == normal) {
      return facts.curve_class;
    }
  }
  return std::nullopt;
}

}  // namespace palpate
