// The main entry point: add contact samples, then ask for a recognition.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/recognition/contacts.h"
#include "core/recognition/recognition.h"
#include "core/recognition/samples/contact_sample.h"
#include "core/recognition/samples/sample_memory.h"
#include "core/recognition/tree/recognition_tree.h"

namespace palpate {

enum class RecognitionMethod {
  MaximumLikelihood,  ///< fits and compares all classes; the tree's path is reported too
  Tree,               ///< only the recognition tree on local estimates, as in the paper
};

struct RecognizerOptions {
  RecognitionMethod method = RecognitionMethod::MaximumLikelihood;
  /// Noise (standard deviation of a coordinate) of samples that state none; 0 = not known. If any
  /// sample then has no noise, the noise of all samples is estimated from the data. [m]
  double sigma_m = 0.0;
  /// Smallest posterior probability of a RECOGNIZED class.
  double recognized_probability = 0.95;
  /// Largest standard deviation of a shape parameter in a RECOGNIZED answer, as a fraction of the
  /// parameter's natural size (verdict/determined.h). Beyond it the linearised covariance means
  /// little.
  double determined_fraction = 0.3;
  /// Form error of the part: standard deviation of its surface from the ideal curve, smooth along
  /// the arc (any correlation). Half of a drawing's +- tolerance. Smooth drift of the probe may be
  /// included. Classes that differ by no more than this are not told apart, however many samples
  /// there are, and covariances include it. The residuals cannot show it: a class with more
  /// parameters can absorb form error into its shape. 0: parts are exactly of their class.
  /// MaximumLikelihood only. [m]
  double form_deviation_m = 0.0;
  /// True if nobody has measured the probe's systematic deviations. Smooth deviations with
  /// the direction of the normal (lobes, tip radius) and along a stroke (drift) are then as
  /// probable as none, of any size that the residuals allow. Covariances and class probabilities
  /// include them. False: they are included only where the residuals look correlated, and a part
  /// that visibly deviates from its class is of no class. Not set: true unless the noise of every
  /// sample is stated: whoever knows that has measured the probe. MaximumLikelihood only.
  std::optional<bool> unqualified_probe;
  /// True if a probe file says by how much the probe deviates: `recognise_probed`
  /// (qualification/probed_recognition.h) sets it, and adds the probe's covariance to the answer.
  /// What deviates smoothly from a class may then be the probe's as well as the part's.
  bool has_probe_file = false;
  /// Where tips touch that have no stated side. Unknown: the answer is that from outside where the
  /// samples allow it; it is RECOGNIZED only if they rule out the others. A line has no outside.
  /// MaximumLikelihood only.
  TouchedFrom touched_from = TouchedFrom::Unknown;
  /// Probability that a scene without spikes loses a sample to outlier rejection.
  double false_outlier_probability = 0.01;
  /// How many times the work of an answer that a planner waits for one may take
  /// (samples/work_limit.h).
  double patience = 1.0;
  /// Classes to consider: bit 1 << CurveClass of each. Default: all.
  unsigned classes = ~0U;
  MemoryOptions memory;
  ContactOptions contacts;
  RecognitionTreeOptions tree;
};

/// Recognises one object from the patches of all probes of a group. Use one recogniser per group.
/// Not thread-safe.
class Recognizer {
 public:
  explicit Recognizer(const RecognizerOptions& options = {});
  ~Recognizer();
  Recognizer(Recognizer&&) noexcept;
  Recognizer& operator=(Recognizer&&) noexcept;

  /// Appends samples of one patch, in their order along the arc. `details`: normal and covariance
  /// of each sample; empty, or as many as samples. A normal shows on which side of a round tip the
  /// surface lies and, if the noise of every sample is known, the curve's direction. A covariance
  /// gives the noise across the curve. For a sample with a covariance, sigma_m must be its
  /// mean_sigma_m. Recognition::simplified_count says what is not used.
  AddResult add(const PatchContext& context, std::span<const ContactSample> samples,
                std::span<const SampleDetail> details = {});

  /// The answer for all samples in memory. The time is linear in the samples, plus a search of
  /// bounded cost. Single touches need no order. Where they lie densely they are joined into runs,
  /// and the local estimates of a run carry the probe and patch number of its first touch. The
  /// status is Collecting until four different places are touched, eight where there are fewer than
  /// four patches. RECOGNIZED needs eight places. With MaximumLikelihood and known noise it needs
  /// two more than the class has unknowns (shape and pose), at least six, and one more for each
  /// outlier.
  Recognition recognize();

  /// Starts or stops the sliding windows (core/local/stream), which make estimates while samples
  /// arrive. They are off at first; recognize() does not need them. If started during a stroke,
  /// they begin with the next sample.
  void stream_estimates(bool on);

  /// Estimates of the sliding windows since the last call, at surface points, in order for each
  /// probe. Estimates of a round tip wait for the first answer if the probe does not state the
  /// material's side. t is 0.
  std::vector<LocalizedContact> take_estimates();

  /// Forgets all samples: a new object begins.
  void reset();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate
