// The words for sides in files, options and Python.
#pragma once

#include <optional>
#include <string_view>

#include "core/recognition/samples/contact_sample.h"

namespace palpate {

/// "outside", "inside" or "unknown"; nullopt for others.
constexpr std::optional<TouchedFrom> touched_from_from_name(std::string_view name) {
  if (name == "unknown") return TouchedFrom::Unknown;
  if (name == "outside") return TouchedFrom::Outside;
  if (name == "inside") return TouchedFrom::Inside;
  return std::nullopt;
}

/// "left", "right" or "unspecified".
constexpr std::string_view name_of(MaterialSide side) {
  return side == MaterialSide::Left    ? "left"
         : side == MaterialSide::Right ? "right"
                                       : "unspecified";
}

/// nullopt for other words.
constexpr std::optional<MaterialSide> material_side_from_name(std::string_view name) {
  for (const MaterialSide side :
       {MaterialSide::Unspecified, MaterialSide::Left, MaterialSide::Right}) {
    if (name == name_of(side)) return side;
  }
  return std::nullopt;
}

}  // namespace palpate
