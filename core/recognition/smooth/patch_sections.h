// Patches cut into sections, each with its polynomial.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/recognition/samples/fit_data.h"
#include "core/recognition/samples/stored_patch.h"
#include "core/recognition/smooth/section_fit.h"

namespace palpate {

/// A section with its polynomial, or without one if its samples stand for themselves.
struct Section {
  PatchSpan points;
  std::optional<SectionFit> fit;
  bool is_part = false;    ///< of a section that no polynomial follows
  std::size_t fitted = 0;  ///< points in the fits that led to it, those that were halved too

  double chi2() const { return fit->polynomials.residual_sum(fit->reduced_degree()); }
  int dof() const { return fit ? static_cast<int>(points.size()) - fit->reduced_degree() - 1 : 0; }
};

/// The sections that one smoothing leaves to the next one of the same object, whatever its frame: a
/// patch whose samples are as they were then is not smoothed again. A value of its own between two
/// answers; what it holds changes no answer by more than rounding.
class KeptSections {
 public:
  /// The sections of patch number `p` of `data`, made of the samples of `patch`, if these and their
  /// noise are as they were when they were kept; their noise may have changed by one factor.
  std::optional<std::vector<Section>> of(std::size_t p, const StoredPatch& patch,
                                         const FitData& data, bool sigma_known) const;

  /// Keeps them, in place of what it had of patch number `p`.
  void keep(std::size_t p, const StoredPatch& patch, const FitData& data, bool sigma_known,
            std::span<const Section> sections);

 private:
  struct Kept {
    std::vector<StoredSample> samples;
    double contacts_per_sample = 1.0;
    std::vector<double> inverse_sigma;  ///< FitPoint's
    bool sigma_known = true;
    double scale = 1.0;             ///< FitData's [m]
    std::vector<Section> sections;  ///< of points from 0 on
  };
  std::vector<Kept> kept_;  ///< by number of the patch
};

/// Where data come from: their patches, and what is kept of their sections; nullptr = nothing.
struct SectionSource {
  std::span<const StoredPatch> patches = {};
  KeptSections* kept = nullptr;
};

/// All patches, cut where they turn and where a high degree does not follow them. White noise that
/// is as stated, or that nobody states, is what sections are kept of. O(points).
std::vector<Section> sections_of_patches(const FitData& data, const SectionNoise& noise,
                                         const SectionSource& source = {});

}  // namespace palpate
