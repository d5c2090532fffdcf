#include "core/recognition/smooth/patch_sections.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "core/recognition/smooth/turning_sections.h"

namespace palpate {
namespace {

/// Fits a section, or its two halves if even a high degree does not follow it (a sharp bend).
void fit_or_halve(const FitData& data, const PatchSpan& points, const SectionNoise& noise,
                  std::vector<Section>* sections, bool is_part = false) {
  auto whole = fit_section(data, points, noise);
  constexpr int kHighDegree = OrthogonalPolynomials::kMaxDegree - 2;
  if (whole && whole->degree >= kHighDegree && points.size() >= 4 * kFewestOfSection) {
    const std::size_t middle = half_way(data, points.begin, points.end);
    const std::size_t first = sections->size();
    fit_or_halve(data, {points.begin, middle}, noise, sections, true);
    fit_or_halve(data, {middle, points.end}, noise, sections, true);
    (*sections)[first].fitted += points.size();
    return;
  }
  sections->push_back({points, std::move(whole), is_part, points.size()});
}

bool is_same(const StoredSample& a, const StoredSample& b) {
  return a.position_m == b.position_m && a.sigma_m == b.sigma_m && a.weight == b.weight &&
         a.contacts == b.contacts;
}

/// Patches of `data`, in their order; empty unless they are those of the stored ones that have
/// samples.
std::vector<const StoredPatch*> stored_patches_of(const FitData& data,
                                                  std::span<const StoredPatch> stored) {
  std::vector<const StoredPatch*> patches;
  for (const StoredPatch& patch : stored) {
    if (!patch.samples.empty()) {
      patches.push_back(&patch);
    }
  }
  return patches.size() == data.patches.size() ? patches : std::vector<const StoredPatch*>{};
}

/// Moves the points of sections on by so many.
std::vector<Section> moved(std::vector<Section> sections, std::ptrdiff_t by) {
  const auto move = [by](PatchSpan* span) {
    span->begin = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(span->begin) + by);
    span->end = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(span->end) + by);
  };
  for (Section& section : sections) {
    move(&section.points);
    if (section.fit) {
      move(&section.fit->section);
    }
  }
  return sections;
}

}  // namespace

std::optional<std::vector<Section>> KeptSections::of(std::size_t p, const StoredPatch& patch,
                                                     const FitData& data, bool sigma_known) const {
  if (p >= kept_.size()) {
    return std::nullopt;
  }
  const Kept& kept = kept_[p];
  const std::span<const FitPoint> points = data.patch(p);
  if (kept.sigma_known != sigma_known || kept.contacts_per_sample != patch.contacts_per_sample ||
      kept.samples.size() != points.size() ||
      !std::equal(kept.samples.begin(), kept.samples.end(), patch.samples.begin(),
                  patch.samples.end(), is_same)) {
    return std::nullopt;
  }
  const double times = points.front().inverse_sigma / kept.inverse_sigma.front();
  constexpr double kSame = 1e-12;  // some roundings
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::abs(points[i].inverse_sigma - times * kept.inverse_sigma[i]) >
        kSame * points[i].inverse_sigma) {
      return std::nullopt;
    }
  }
  auto sections = moved(kept.sections, static_cast<std::ptrdiff_t>(data.patches[p].begin));
  for (Section& section : sections) {
    section.fitted = 0;
    if (section.fit) {
      section.fit->frame = chord_frame(data.points[section.points.begin].position,
                                       data.points[section.points.end - 1].position);
      section.fit->polynomials.rescale(kept.scale / data.scale, times * times);
    }
  }
  return sections;
}

void KeptSections::keep(std::size_t p, const StoredPatch& patch, const FitData& data,
                        bool sigma_known, std::span<const Section> sections) {
  kept_.resize(std::max(kept_.size(), p + 1));
  Kept& kept = kept_[p];
  kept.samples = patch.samples;
  kept.contacts_per_sample = patch.contacts_per_sample;
  kept.inverse_sigma.clear();
  for (const FitPoint& point : data.patch(p)) {
    kept.inverse_sigma.push_back(point.inverse_sigma);
  }
  kept.sigma_known = sigma_known;
  kept.scale = data.scale;
  kept.sections = moved({sections.begin(), sections.end()},
                        -static_cast<std::ptrdiff_t>(data.patches[p].begin));
}

std::vector<Section> sections_of_patches(const FitData& data, const SectionNoise& noise,
                                         const SectionSource& source) {
  // Noise beyond kLargestNoise cuts by the scale as well (turning_sections.cpp).
  const bool may_keep = source.kept != nullptr && noise.variance == 1.0 && noise.time == 1.0 &&
                        (!noise.known || rms_sigma(data) < kLargestNoise);
  const std::vector<const StoredPatch*> stored =
      may_keep ? stored_patches_of(data, source.patches) : std::vector<const StoredPatch*>{};
  KeptSections* const kept = stored.empty() ? nullptr : source.kept;
  std::vector<Section> sections;
  for (std::size_t p = 0; p < data.patches.size(); ++p) {
    const PatchSpan& patch = data.patches[p];
    if (patch.size() == 0) {
      continue;  // every sample was set aside
    }
    const bool may_be_kept = kept != nullptr && patch.size() >= kFewestOfSection &&
                             stored[p]->samples.size() == patch.size();
    auto before = may_be_kept ? kept->of(p, *stored[p], data, noise.known) : std::nullopt;
    if (before) {
      std::move(before->begin(), before->end(), std::back_inserter(sections));
      continue;
    }
    const std::size_t first = sections.size();
    for (const PatchSpan& points : sections_of(data, patch, noise.known)) {
      fit_or_halve(data, points, noise, &sections);
    }
    if (may_be_kept) {
      kept->keep(p, *stored[p], data, noise.known, std::span(sections).subspan(first));
    }
  }
  return sections;
}

}  // namespace palpate
