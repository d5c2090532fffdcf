// What is wrong with patches of samples, told to whoever took them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/recognition/samples/contact_sample.h"
#include "core/recognition/samples/sample_detail.h"

namespace palpate {

enum class Severity { Note, Warning, Error };

struct Finding {
  Severity severity = Severity::Note;
  std::string probe;  ///< empty = no probe's in particular
  std::string what;   ///< what was seen, with its numbers
  std::string cure;   ///< what to do about it
  /// An answer from these samples would be wrong or worth less, whatever the recogniser makes of
  /// it.
  bool spoils_answer = false;
  bool has_no_order = false;  ///< rows of a stroke lead to and fro instead of along the part
  std::string object = {};    ///< "group g, object 1: ", where there are several; empty = alone
};

struct CheckedNormal {
  Vec2 normal = Vec2::Zero();  ///< zero = not measured
  double sigma_rad = 0.0;      ///< as stated
};

/// What is kept of a patch for judgement.
struct CheckedPatch {
  std::uint32_t number = 0;
  std::uint64_t object = 0;
  double tip_radius_m = 0.0;
  MaterialSide material_side = MaterialSide::Unspecified;
  std::vector<Vec2> positions = {};
  std::vector<CheckedNormal> normals = {};  ///< by position; empty where there are none
  double sigma_squares = 0.0;
  std::size_t with_sigma = 0;

  /// `detail`: nullptr where the sample says no more.
  void take(const Vec2& position_m, double sigma_m, const SampleDetail* detail);

  /// Root mean square of the standard deviations that its samples state, 0 where none does. [m]
  double stated_sigma_m() const;
};

/// Where patches came from, or rather who is told: the cures differ.
enum class CheckedSource { Stream, File, Arrays };

/// The one of three cures that is of this source.
inline const char* cure_of(CheckedSource source, const char* stream, const char* file,
                           const char* arrays) {
  return source == CheckedSource::Stream ? stream : source == CheckedSource::File ? file : arrays;
}

/// Units, spacing, noise, jumps and repeats of a probe's patches.
void judge_patches(const std::string& probe, const std::vector<CheckedPatch>& patches,
                   CheckedSource source, std::vector<Finding>* findings);

/// What is said of so many samples with one stamp between them.
std::string one_stamp_text(std::size_t samples);

/// Worst first, else in their order.
void sort_findings(std::vector<Finding>* findings);

/// "ERROR  ", "WARNING" or "note   ".
const char* name_of(Severity severity);

}  // namespace palpate
