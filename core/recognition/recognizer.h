// The facade: add contact samples, ask for a recognition.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/recognition/recognition.h"

namespace palpate {

/// Side of the direction of travel on which the material lies.
enum class MaterialSide { Unspecified, Left, Right };

struct ContactSample {
  Vec2 position_m = Vec2::Zero();
  double sigma_m = 0.0;  ///< 1-sigma isotropic position noise; 0 = not known [m]
  std::int64_t stamp_ns = 0;
};

/// Where a run of samples belongs: one unbroken touch of one probe.
struct PatchContext {
  std::uint32_t probe = 0;
  std::uint32_t patch = 0;
  double tip_radius_m = 0.0;  ///< samples are centres of a round tip of this radius; 0 = surface
  MaterialSide material_side = MaterialSide::Unspecified;
};

struct RecognizerOptions {
  /// Noise of samples that bring no sigma of their own; 0 = estimate it from the data. [m]
  double sigma_m = 0.0;
  /// RECOGNIZED needs posterior >= this.
  double recognized_probability = 0.95;
};

/// Samples taken and samples refused, by reason.
struct AddResult {
  std::size_t accepted = 0;
  std::size_t rejected_not_finite = 0;
};

/// Recognises one object from the patches of all probes of a group. Not thread-safe; create one
/// per group.
class Recognizer {
 public:
  explicit Recognizer(const RecognizerOptions& options = {});
  ~Recognizer();
  Recognizer(Recognizer&&) noexcept;
  Recognizer& operator=(Recognizer&&) noexcept;

  /// Appends samples of one patch in their order along the arc.
  AddResult add(const PatchContext& context, std::span<const ContactSample> samples);

  /// The answer for all samples in memory.
  Recognition recognize();

  /// Forgets everything: a new object.
  void reset();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate
