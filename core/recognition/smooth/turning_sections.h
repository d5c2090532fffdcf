// A patch cut where it turns: pieces that are graphs over their chords.
#pragma once

#include <cstddef>
#include <vector>

#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// A section shorter than this tells nothing about noise: of fewer, a parabola leaves no three
/// residuals.
inline constexpr std::size_t kFewestOfSection = 6;

/// Sections of one patch, each of which turns by less than a radian or so, by the chords between
/// means of a few points. A mean that noise may have put where it is has no chord of its own: noise
/// would turn it any way, and cut a patch that does not bend. `sigma_known`: the points bring their
/// noise. O(points).
std::vector<PatchSpan> sections_of(const FitData& data, const PatchSpan& patch, bool sigma_known);

}  // namespace palpate
