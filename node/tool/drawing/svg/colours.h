// Colours with the same meaning in every drawing. All are readable on white.
#pragma once

namespace palpate {

inline constexpr const char* kPatchColours[] = {"#0072b2", "#b85000", "#00805f", "#a64d8b",
                                                "#8a6600", "#35758f", "#7a4b2b", "#5b5b5b"};
inline constexpr const char* kCurveColour = "#1b1f24";
inline constexpr const char* kBandColour = "#2f7fd6";

}  // namespace palpate
