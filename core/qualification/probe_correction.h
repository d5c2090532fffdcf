// Recognition of parts that were touched by qualified probes.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/curves/curve.h"
#include "core/qualification/probe_character.h"
#include "core/recognition/recognizer.h"
#include "core/recognition/samples/sample_memory.h"

namespace palpate {

/// A patch as recorded, and the probe that touched it (nullptr = an unqualified probe).
struct ProbedPatch {
  PatchContext context;
  std::vector<ContactSample> samples;
  const ProbeCharacter* probe = nullptr;
  std::vector<SampleDetail> details = {};  ///< of the samples; empty if no sample has any
};

/// The side of the material of a patch, seen along increasing curve parameter: +1 left, -1 right, 0
/// unknown. With a tip radius: the side where the tip centres are not. Without: the stated side, or
/// else the inner side of the bend, or the outer one of a part that is touched from inside.
int material_sign(const Curve& curve, const Pose2& world_T_curve, const ProbedPatch& patch,
                  TouchedFrom touched_from = TouchedFrom::Unknown);

/// The samples minus the probe's offset along the normals of a curve that fits them. An error e of
/// the normal causes an error of (slope of the offset) times e: some micrometres for an offset of
/// 0.1 mm and normals known to 1 degree. A second round, with the curve through the corrected
/// samples, leaves only the product of two such errors.
std::vector<ContactSample> without_offset(const ProbedPatch& patch, const Curve& curve,
                                          const Pose2& world_T_curve,
                                          TouchedFrom touched_from = TouchedFrom::Unknown);

/// The patch with the probe's tip radius, and with the probe's noise for samples that state none.
ProbedPatch as_qualified(ProbedPatch patch);

/// Covariance of [shape; x; y; theta] that the probes' properties add to that of white noise:
///   (J^T W J)^-1 J^T W (B S B^T + D) W J (J^T W J)^-1.
/// J are the derivatives of the distances and W the inverse variances of the noise. S is the
/// covariance of the offset's coefficients in another set-up, B their effect on the samples. D is
/// the covariance of the coherent deviation, deviation^2 exp(-distance / length) within a patch.
/// Unlike `form_deviation_m`, this is no bound over all coherences, because the probe file knows
/// the length.
ShapePoseCovariance covariance_of_probes(const Curve& curve, const Pose2& world_T_curve,
                                         std::span<const ProbedPatch> patches,
                                         TouchedFrom touched_from = TouchedFrom::Unknown);

/// Factor by which the coherent deviation of the probe files enlarges the covariance of white
/// noise, for quantities that vary slowly: 1 + the mean over the samples of sum_j D_ij / sigma_i^2.
double inflation_of_probes(std::span<const ProbedPatch> patches);

struct ProbedRecognition {
  Recognition recognition;
  AddResult added;
  /// Whether the offsets were removed. False if no curve was found whose normals could be used.
  bool corrected = false;
};

/// Recognises, removes the offsets along the normals of the curve found, and repeats this: four
/// recognitions in all. In the first, the lobes that are still in the samples count as form
/// deviation: without, no class fits where they are larger than the noise.
///
/// For the class, and for RECOGNIZED, the coherent deviation of the probes counts as form
/// deviation, with what the lobes are uncertain by, in addition to that of the options: a bound
/// over all coherences. The covariance of the best class comes from a recognition of its own, with
/// white noise and the stated form deviation, plus covariance_of_probes. Coherence of the residuals
/// beyond what the files say enlarges it further. An answer whose shape this leaves undetermined is
/// not RECOGNIZED. `options.unqualified_probe` concerns patches without a file.
ProbedRecognition recognise_probed(std::span<const ProbedPatch> patches, RecognizerOptions options);

/// The same for an object whose samples are in memory. `probes` is indexed by the probe number of a
/// patch. A sample that is a mean of neighbours is corrected as one sample with accordingly less
/// noise; if no noise is stated, it counts as one sample.
ProbedRecognition recognise_probed(const SampleMemory& memory,
                                   std::span<const ProbeCharacter* const> probes,
                                   RecognizerOptions options);

}  // namespace palpate
