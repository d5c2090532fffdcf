// An ordinary scene, as the reference for other conditions.
#pragma once

#include <random>

#include "tests/bench/worst_case/touched_input.h"

namespace palpate::bench {

/// A part of one of the eight classes or of none: 1 to 4 patches of 111 samples, correctly stated
/// noise, samples on the surface.
InputRecipe plain_recipe(std::mt19937_64& rng);

}  // namespace palpate::bench
