// The facade: add contact samples, ask for a recognition.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/recognition/contacts.h"
#include "core/recognition/recognition.h"
#include "core/recognition/samples/contact_sample.h"
#include "core/recognition/samples/sample_memory.h"
#include "core/recognition/tree/recognition_tree.h"

namespace palpate {

enum class RecognitionMethod {
  MaximumLikelihood,  ///< all classes fitted and weighed; the tree reports its path
  Tree,               ///< the recognition tree on local estimates alone, as in the paper
};

struct RecognizerOptions {
  RecognitionMethod method = RecognitionMethod::MaximumLikelihood;
  /// Noise of samples that bring no sigma of their own; 0 = estimate it from the data. [m]
  double sigma_m = 0.0;
  /// RECOGNIZED needs posterior >= this.
  double recognized_probability = 0.95;
  /// RECOGNIZED needs every shape parameter's standard deviation <= this fraction of the parameter
  /// (of 1 for the dimensionless b and c of the cubics): beyond it the linearised covariance means
  /// little.
  double determined_fraction = 0.3;
  /// What is known of the part's making: the standard deviation of its surface from its ideal
  /// curve, smooth along the arc in whatever way (half of a drawing's +- tolerance); drift of the
  /// probe counts the same. Classes that differ by no more are not told apart, however many the
  /// samples, and covariances hold it. Residuals cannot show form error that a class of more
  /// parameters takes for shape: 0 says that parts are exactly of their class. Maximum likelihood
  /// only. [m]
  double form_deviation_m = 0.0;
  /// Nobody has measured how the probe deviates, and it may do so smoothly: by the direction of the
  /// normal (lobes, its radius) and along a stroke (drift), as probable as not, in whatever size
  /// residuals leave possible. Covariances and the odds of the classes hold it. Otherwise it counts
  /// only where residuals look so. Maximum likelihood only; costs a few milliseconds an answer.
  bool unqualified_probe = false;
  /// Probability that a scene without spikes loses a sample to outlier rejection.
  double false_outlier_probability = 0.01;
  /// Classes to consider, by bit 1 << CurveClass; all by default.
  unsigned classes = ~0U;
  MemoryOptions memory;
  ContactOptions contacts;
  RecognitionTreeOptions tree;
};

/// Recognises one object from the patches of all probes of a group. Not thread-safe; one per group.
class Recognizer {
 public:
  explicit Recognizer(const RecognizerOptions& options = {});
  ~Recognizer();
  Recognizer(Recognizer&&) noexcept;
  Recognizer& operator=(Recognizer&&) noexcept;

  /// Appends samples of one patch in their order along the arc. `details`: normals and covariances
  /// of the samples, or nothing. A normal tells on which side of a round tip the surface lies, and
  /// where every noise is known the curve's direction there; a covariance tells the noise across
  /// the curve. Beside one a sample's sigma_m is its mean (mean_sigma_m).
  /// Recognition::simplified_count says what does not count.
  AddResult add(const PatchContext& context, std::span<const ContactSample> samples,
                std::span<const SampleDetail> details = {});

  /// The answer for all samples in memory. Linear in the samples, beside a search of bounded cost.
  /// Touches alone in their patch need no order; where they lie densely they are taken together,
  /// and their local estimates bear the name of the first of them. From four patches on there is an
  /// answer; it is not RECOGNIZED before eight places have been touched.
  Recognition recognize();

  /// From now on the sliding windows run along with the samples (core/local/stream), or no longer.
  /// They are off at first: nothing in recognize() needs them. Switched on in the middle of a
  /// stroke, they begin there.
  void stream_estimates(bool on);

  /// The windows' estimates that no call before has given, in order for each probe, on the surface.
  /// Those of a round tip wait for the first answer where the probe does not tell the side that the
  /// material is on. t is 0.
  std::vector<LocalizedContact> take_estimates();

  /// Forgets everything: a new object.
  void reset();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate
