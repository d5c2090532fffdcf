// Sections that their polynomials follow, and where none does, the samples themselves.
#pragma once

#include <cstddef>
#include <vector>

#include "core/recognition/smooth/patch_sections.h"

namespace palpate {

/// With fewer degrees of freedom the sections do not show a noise that nobody states: what a
/// polynomial leaves of few samples round a bend looks like noise, and is form. Every sample then
/// stands for itself. The search hardly has more points for that: a section's reduced points are
/// up to five, of a dozen samples.
inline constexpr int kDegreesThatShowNoise = 20;

/// What is thought of a stated noise if all sections leave more: that it is too low, or that they
/// do not follow the path.
enum class StatedNoise { MayBeTooLow, Holds };

struct FollowedSections {
  std::vector<Section> sections;
  std::size_t fitted = 0;  ///< points in the fits of all sections, those that did not last too
};

/// The sections of all patches. Those whose polynomial leaves more than noise are halved until it
/// follows, or stand for themselves. `source`: as sections_of_patches(). O(points).
FollowedSections followed_sections(const FitData& data, SectionNoise noise, StatedNoise stated,
                                   const SectionSource& source);

}  // namespace palpate
