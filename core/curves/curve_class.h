// The curve classes that palpate recognises: names, shape parameters, symmetry.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace palpate {

enum class CurveClass {
  Unclassified,
  Line,
  Circle,
  Ellipse,
  Parabola,
  Hyperbola,
  CubicalParabola,
  SemiCubicalParabola,
  CubicSpline,
};

inline constexpr std::array kCurveClasses = {
    CurveClass::Line,
    CurveClass::Circle,
    CurveClass::Ellipse,
    CurveClass::Parabola,
    CurveClass::Hyperbola,
    CurveClass::CubicalParabola,
    CurveClass::SemiCubicalParabola,
    CurveClass::CubicSpline,
};

/// A value for each class.
template <typename T>
struct ByClass : std::array<T, kCurveClasses.size() + 1> {
  using std::array<T, kCurveClasses.size() + 1>::operator[];
  constexpr T& operator[](CurveClass c) { return (*this)[static_cast<std::size_t>(c)]; }
  constexpr const T& operator[](CurveClass c) const { return (*this)[static_cast<std::size_t>(c)]; }
};

/// Lower-case name with underscores ("semi_cubical_parabola").
std::string_view name_of(CurveClass curve_class);

/// The class with that name; case is ignored, and hyphens and spaces count as underscores. nullopt
/// if there is none.
std::optional<CurveClass> curve_class_from_name(std::string_view name);

/// Letters of the shape parameters in their order: "a" (circle, parabola), "ab" (ellipse,
/// hyperbola, semi-cubical parabola), "ac" (cubical parabola), "abc" (cubic spline), "" (line,
/// unclassified). Canonical forms: core/README.md, "Curves".
std::string_view parameter_letters(CurveClass curve_class);

/// Order of the rotation symmetry of the pose: 2 for ellipse and cubical parabola, 1 for the other
/// curves, 0 for a continuous symmetry (circle: free rotation; line: free sliding).
int pose_symmetry(CurveClass curve_class);

/// Number of parameters of shape and pose together that points on the curve can determine: line 2,
/// circle 3, parabola 4, ellipse, hyperbola, cubical and semi-cubical parabola 5, spline 6.
int degrees_of_freedom(CurveClass curve_class);

}  // namespace palpate
