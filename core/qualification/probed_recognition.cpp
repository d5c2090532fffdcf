#include "core/qualification/probed_recognition.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/recognition/verdict/determined.h"

namespace palpate {
namespace {

AddResult add_all(std::span<const ProbedPatch> patches, Recognizer& recognizer) {
  AddResult sum;
  for (const ProbedPatch& patch : patches) {
    sum += recognizer.add(patch.context, patch.samples, patch.details);
  }
  return sum;
}

/// The curve of the most probable class; nullopt if there is none.
std::optional<Curve> curve_of(const Recognition& answer) {
  return answer.hypotheses.empty() || answer.hypotheses.front().at_limit
             ? std::nullopt
             : make_curve(answer.shape.curve_class, answer.shape.values);
}

Eigen::AlignedBox2d box_of(std::span<const ProbedPatch> patches) {
  Eigen::AlignedBox2d box;
  for (const ProbedPatch& patch : patches) {
    for (const ContactSample& sample : patch.samples) box.extend(sample.position_m);
  }
  return box;
}

/// Mean squares of what probes do to samples and no noise of one sample holds. [m^2]
struct ProbeSquares {
  double coherent = 0.0;  ///< what is left when the lobes are taken off
  double lobes = 0.0;
};

ProbeSquares probe_squares(std::span<const ProbedPatch> patches) {
  ProbeSquares squares;
  for (const ProbedPatch& patch : patches) {
    if (patch.probe == nullptr) continue;
    squares.coherent = std::max(squares.coherent, mean_square(patch.probe->deviation_m) +
                                                      mean_variance_of_lobes(patch.probe->offset));
    squares.lobes = std::max(squares.lobes, mean_square_of_lobes(patch.probe->offset));
  }
  return squares;
}

RecognizerOptions with_deviation(RecognizerOptions options, double square_m2) {
  options.form_deviation_m =
      std::sqrt(options.form_deviation_m * options.form_deviation_m + square_m2);
  return options;
}

/// The recognition of samples without their probes' offsets, and those samples.
struct Corrected {
  ProbedRecognition result;
  std::vector<ProbedPatch> patches;
  std::optional<Curve> along;  ///< along whose normals the offsets were taken off, if they were
  Pose2 world_T_curve;
};

/// Recognises, takes the offsets off along the normals of the curve found, and recognises again.
/// What the probes leave is a form deviation, the lobes too before they are taken off: else no
/// class fits.
Corrected corrected(std::vector<ProbedPatch> raw, const RecognizerOptions& options) {
  const ProbeSquares squares = probe_squares(raw);
  Corrected corrected;
  corrected.patches = raw;
  for (int round = 0; round <= kCorrectionRounds; ++round) {
    Recognizer recognizer(
        with_deviation(options, squares.coherent + (round == 0 ? squares.lobes : 0.0)));
    corrected.result.added = add_all(corrected.patches, recognizer);
    Recognition& answer = corrected.result.recognition = recognizer.recognize();
    const std::optional<Curve> curve = curve_of(answer);
    if (!curve || round == kCorrectionRounds) break;
    corrected.along = curve;
    corrected.world_T_curve = answer.world_T_curve;
    for (std::size_t i = 0; i < raw.size(); ++i) {
      // Always from the original samples: only the normals change from round to round.
      corrected.patches[i].samples =
          without_offset(raw[i], *curve, answer.world_T_curve, options.touched_from);
    }
    corrected.result.corrected = true;
  }
  return corrected;
}

/// Takes shape, place and covariance of a recognition without a form deviation, if it is of the
/// same class: the cautious covariance contains the deviations of probes already.
void take_plain(std::span<const ProbedPatch> patches, const RecognizerOptions& options,
                Recognition* answer) {
  Recognizer recognizer(options);
  add_all(patches, recognizer);
  const Recognition plain = recognizer.recognize();
  if (!curve_of(plain) || plain.shape.curve_class != answer->shape.curve_class ||
      plain.covariance.size() == 0) {
    return;
  }
  Hypothesis& best = answer->hypotheses.front();
  answer->shape = best.shape = plain.shape;
  answer->world_T_curve = best.world_T_curve = plain.world_T_curve;
  answer->covariance = plain.covariance;
  answer->white_covariance = plain.white_covariance;
  answer->covariance_inflation = plain.covariance_inflation;
  best.covariance = plain.hypotheses.front().covariance;
  // If neighbours err together, the deviations of the files explain part of it; these are added
  // afterwards. (With a stated form deviation, or with patches of a probe without a file, the two
  // cannot be separated, and both count.)
  if (options.has_probe_file && !plain.unqualified_probe && plain.white_covariance.size() > 0) {
    const double seen = plain.covariance_inflation;
    const bool together = plain.noise_correlation_m > 0.0 && !(options.form_deviation_m > 0.0);
    const double share = together ? std::max(1.0, seen / inflation_of_probes(patches)) : seen;
    answer->covariance = best.covariance = share * plain.white_covariance;
  }
}

/// Adds what the files of the probes leave open.
void add_probes(std::span<const ProbedPatch> patches, const RecognizerOptions& options,
                Recognition* answer) {
  const std::optional<Curve> curve = curve_of(*answer);
  if (!curve || answer->covariance.size() == 0) return;
  const ShapePoseCovariance more =
      covariance_of_probes(*curve, answer->world_T_curve, patches, options.touched_from);
  if (more.rows() != answer->covariance.rows()) return;
  answer->covariance += more;
  answer->hypotheses.front().covariance += more;
  if (answer->status == RecognitionStatus::Recognized &&
      !is_determined(answer->shape, answer->covariance, half_extent_m(box_of(patches)),
                     options.determined_fraction)) {
    answer->status = RecognitionStatus::Ambiguous;
    answer->doubt = Doubt::Undetermined;
  }
}

}  // namespace

ProbedRecognition recognise_probed(std::span<const ProbedPatch> patches,
                                   RecognizerOptions options) {
  // A patch with a file has a noise, so that others decide whether one is not stated.
  const auto has_file = [](const ProbedPatch& patch) { return patch.probe != nullptr; };
  if (std::all_of(patches.begin(), patches.end(), has_file)) {
    options.unqualified_probe = false;
  }
  options.has_probe_file =
      options.has_probe_file || std::any_of(patches.begin(), patches.end(), has_file);
  std::vector<ProbedPatch> raw;
  for (const ProbedPatch& patch : patches) {
    raw.push_back(as_qualified(patch));
  }
  auto [result, used, along, world_T_curve] = corrected(std::move(raw), options);
  if (curve_of(result.recognition)) {
    take_plain(used, options, &result.recognition);
    add_probes(used, options, &result.recognition);
  }
  if (along) {
    add_offset_uncertainty(used, *along, world_T_curve, options.touched_from,
                           &result.recognition.contacts);
  }
  return std::move(result);
}

ProbedRecognition recognise_probed(const SampleMemory& memory,
                                   std::span<const ProbeCharacter* const> probes,
                                   RecognizerOptions options) {
  std::vector<ProbedPatch> patches;
  for (const StoredPatch& stored : memory.patches()) {
    const ProbeCharacter* const probe = probes[stored.context.probe];
    ContactRun run = as_contacts(stored);
    for (std::size_t i = 0; probe != nullptr && i < run.samples.size(); ++i) {
      // Before the weight applies: the probe's noise is that of one contact.
      ContactSample& sample = run.samples[i];
      if (!(sample.sigma_m > 0.0)) {
        sample.sigma_m = probe->sigma_m.value / std::sqrt(stored.samples[i].weight);
      }
    }
    patches.push_back({run.context, std::move(run.samples), probe, std::move(run.details)});
  }
  // No limit below the number present: the memory has already dropped what had to make room.
  options.memory.most_patches = std::max<std::size_t>(patches.size(), 1);
  options.memory.most_lone_touches = std::max<std::size_t>(patches.size(), 1);
  ProbedRecognition result = recognise_probed(patches, options);
  result.recognition.sample_count = memory.sample_count();
  return result;
}

}  // namespace palpate
