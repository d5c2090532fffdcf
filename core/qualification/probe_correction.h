// Recognition of what a qualified probe has touched.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/curves/curve.h"
#include "core/qualification/probe_character.h"
#include "core/recognition/recognizer.h"
#include "core/recognition/samples/sample_memory.h"

namespace palpate {

/// A patch as it came, and the probe that touched it (nullptr = one that nobody has qualified).
struct ProbedPatch {
  PatchContext context;
  std::vector<ContactSample> samples;
  const ProbeCharacter* probe = nullptr;
  std::vector<SampleDetail> details = {};  ///< of the samples; empty where none says more
};

/// On which side of increasing curve parameter the material of a patch lies: +1 left, -1 right.
/// Where the tip's centres are not; without a tip as stated, else inside of the bend. 0 = not
/// known.
int material_sign(const Curve& curve, const Pose2& world_T_curve, const ProbedPatch& patch);

/// The samples less the probe's offset along the normals of a curve that lies along them. The
/// normals' error e costs the offset's slope times e: with an offset of 0.1 mm and normals known to
/// 1 degree some micrometres; a second round, with the curve through the corrected samples, leaves
/// the product of two such errors.
std::vector<ContactSample> without_offset(const ProbedPatch& patch, const Curve& curve,
                                          const Pose2& world_T_curve);

/// As the probe says: tip radius, and the noise of samples that bring none.
ProbedPatch as_qualified(ProbedPatch patch);

/// Covariance of [shape; x; y; theta] that the probes' qualities put there beside white noise, J
/// the distances' derivatives and W the noise's inverse variances:
///   (J^T W J)^-1 J^T W (B S B^T + D) W J (J^T W J)^-1,
/// S the covariance of the offset's coefficients in a set-up of its own, B what these move the
/// samples by, and D the covariance of the coherent deviation, deviation^2 exp(-distance / length)
/// within a patch. No bound over all coherences as `form_deviation_m` is: the probe file knows the
/// length.
ShapePoseCovariance covariance_of_probes(const Curve& curve, const Pose2& world_T_curve,
                                         std::span<const ProbedPatch> patches);

/// What a coherent deviation as the probes' files have it multiplies the covariance of white noise
/// by, for what varies slowly: 1 + the mean over samples of sum_j D_ij / sigma_i^2.
double inflation_of_probes(std::span<const ProbedPatch> patches);

struct ProbedRecognition {
  Recognition recognition;
  AddResult added;
  /// Whether the offsets have been taken off; not where no curve was found to take normals from.
  bool corrected = false;
};

/// Recognises, takes the offsets off by the normals found, and again. Which class it is, and
/// whether it is RECOGNIZED, is decided with the probes' coherent deviation counted as form
/// deviation beside the options' own: the bound over all coherences. The covariance of the best
/// class is that of white noise and the stated form deviation, from a recognition of its own, with
/// covariance_of_probes; what its residuals tell of coherence beyond the files' enlarges it as
/// ever. An answer whose shape that leaves undetermined is not RECOGNIZED. Four recognitions.
/// `options.unqualified_probe` is for patches without a file.
ProbedRecognition recognise_probed(std::span<const ProbedPatch> patches, RecognizerOptions options);

/// The same of an object whose samples are in memory. `probes`: by the patches' number of their
/// probe. A mean of neighbours is corrected as one sample of so much less noise; without any noise
/// stated it counts as one.
ProbedRecognition recognise_probed(const SampleMemory& memory,
                                   std::span<const ProbeCharacter* const> probes,
                                   RecognizerOptions options);

}  // namespace palpate
