// What the file of a qualified probe takes off samples, and what it leaves open.
#pragma once

#include <span>
#include <vector>

#include "core/curves/curve.h"
#include "core/curves/shape_parameters.h"
#include "core/qualification/probe_character.h"
#include "core/recognition/localized_contact.h"
#include "core/recognition/samples/contact_sample.h"
#include "core/recognition/samples/sample_detail.h"

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

/// Rounds of taking offsets off along the normals of the curve found. Lobes move a curve by no more
/// than they are, a hundredth of a part at most, and so turn its normals by hundredths: the second
/// round leaves of their offsets hundredths of hundredths.
inline constexpr int kCorrectionRounds = 2;

/// Adds to the contacts of patches that an offset was taken off what it leaves open in another
/// set-up.
void add_offset_uncertainty(std::span<const ProbedPatch> patches, const Curve& curve,
                            const Pose2& world_T_curve, TouchedFrom touched_from,
                            std::vector<LocalizedContact>* contacts);

}  // namespace palpate
