// Noise that nobody states may differ from stroke to stroke.
#pragma once

#include "core/recognition/samples/fit_data.h"

namespace palpate {

/// Gives strokes whose noise is not stated the ratios of the noise that each shows by itself, if
/// that of any differs from the others' by more than chance: two fingers, or one that was moved
/// faster. By one noise for all, the path of the noisier stroke would follow its noise, and a class
/// that does not would misfit. Only ratios count: the noise is estimated later. O(points).
void weigh_strokes(FitData* data);

}  // namespace palpate
