// Recognition of parts that were touched by qualified probes.
#pragma once

#include <span>

#include "core/qualification/probe_correction.h"
#include "core/recognition/recognizer.h"
#include "core/recognition/samples/sample_memory.h"

namespace palpate {

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
