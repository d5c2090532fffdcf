// Inputs of the recognizer, described by a few numbers that a search can change: any shape or none,
// noise, tips, patches, spikes.
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "core/recognition/recognizer.h"

namespace palpate::bench {

struct TouchedPatch {
  PatchContext context;
  std::vector<ContactSample> samples;
};

using TouchedInput = std::vector<TouchedPatch>;

std::size_t sample_count(const TouchedInput& input);

enum class Shape {
  Line,
  Circle,
  Ellipse,
  Parabola,
  Hyperbola,
  CubicalParabola,
  SemiCubicalParabola,
  CubicSpline,
  Sinusoid,
  Superellipse,
  LogSpiral,
  Quartic,
  FreeForm,    ///< a closed curve of random harmonics
  Polygon,     ///< corners
  RandomWalk,  ///< no curve at all
};
inline constexpr int kShapes = 15;

/// Parameters of an input. Lengths are in units of the part's half extent unless stated otherwise.
struct InputRecipe {
  Shape shape = Shape::Ellipse;
  std::uint64_t seed = 0;  ///< of everything random below
  int patches = 2;         ///< 1 to 64
  int samples = 111;       ///< per patch, 8 to 4096
  double size_m = 0.025;
  double arc = 0.5;               ///< of each patch
  double coverage = 1.0;          ///< patches begin within this share of the curve
  double sigma = 1e-3;            ///< noise of the samples
  double shared_noise = 0.0;      ///< correlation of neighbours' noise, 0 to 1; 0 = white
  double stated_over_true = 1.0;  ///< stated sigma divided by the true one; 0 = not stated
  double spikes = 0.0;            ///< share of samples, 0 to 0.3
  double spike_size = 0.1;
  double tip = 0.0;           ///< tip radius; 0 = samples on the surface
  double sides_told = 1.0;    ///< share of patches whose material side is stated
  double misplacement = 0.0;  ///< standard deviation of each patch's shift
  double wave = 0.0;          ///< amplitude of a form deviation, smooth along the arc
  double dwelling = 0.0;      ///< share of samples that stay at the place of the one before
  double standing = 0.0;      ///< share of a patch's samples at one place, each with its own noise
  int passes = 1;             ///< over each patch, back and forth
  double offset = 0.0;        ///< of the part from the origin
};

/// Restriction of a search, to find the most expensive input of each kind.
enum class InputKind {
  Any,
  Plain,     ///< no tips, no spikes, noise stated
  Tips,      ///< plain, but with tips whose sides are stated
  Sides,     ///< plain, but with tips whose sides are not stated
  Spikes,    ///< plain, but with spikes
  Unstated,  ///< plain, but the noise is not stated
  Few,       ///< at most 32 samples
  Patches,   ///< at least 16 patches
};

/// The kind of that name on a command line; nullopt if there is none.
std::optional<InputKind> input_kind(std::string_view name);

/// A random recipe within the bounds stated at each member.
InputRecipe random_recipe(std::mt19937_64& rng, InputKind kind, std::size_t most_samples);

/// The recipe with one to three members drawn again or changed a little.
InputRecipe mutated(InputRecipe recipe, std::mt19937_64& rng, InputKind kind,
                    std::size_t most_samples);

TouchedInput input_of(const InputRecipe& recipe);

/// A clean ellipse, touched all around, with as many patches and samples as the input.
TouchedInput clean_ellipse_like(const TouchedInput& input, std::uint32_t seed = 1);

/// The recipe on one line.
std::string to_text(const InputRecipe& recipe);

}  // namespace palpate::bench
