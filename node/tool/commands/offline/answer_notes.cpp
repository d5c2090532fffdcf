#include "node/tool/commands/offline/answer_notes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "node/files/quantity.h"

namespace palpate {
namespace {

/// Whether something tells on which side of these samples the material is.
bool tells_side(const ContactRun& run, bool is_alone) {
  const bool has_normal =
      std::any_of(run.details.begin(), run.details.end(),
                  [](const SampleDetail& detail) { return detail.normal_sigma_rad > 0.0; });
  // A touch alone has no direction of travel that could have a left.
  return has_normal || (run.context.material_side != MaterialSide::Unspecified && !is_alone);
}

}  // namespace

Stated stated_of(const ContactGroup& group, const RecognizerOptions& options, bool noise_is_known) {
  const bool tip_sides =
      std::all_of(group.runs.begin(), group.runs.end(), [](const ContactRun& run) {
        return run.context.tip_radius_m == 0.0 || tells_side(run, run.samples.size() == 1);
      });
  return {noise_is_known, options.touched_from != TouchedFrom::Unknown, tip_sides,
          options.form_deviation_m};
}

std::string note_of_tip_side(const ContactGroup& group, const v1::Recognition& answer,
                             TouchedFrom touched_from) {
  if (touched_from != TouchedFrom::Unknown) return {};
  if (answer.curve_class() != v1::CURVE_CLASS_CIRCLE || !answer.has_parameters()) return {};
  const Vec2 centre(answer.pose().x_m(), answer.pose().y_m());
  const double radius = answer.parameters().a();
  double radii_of_centres = 0.0;
  std::size_t samples = 0;
  for (const ContactRun& run : group.runs) {
    if (run.context.tip_radius_m == 0.0 || tells_side(run, run.samples.size() == 1)) return {};
    for (const ContactSample& sample : run.samples) {
      radii_of_centres += (sample.position_m - centre).norm();
      ++samples;
    }
  }
  if (samples == 0) return {};
  const bool is_within = radius < radii_of_centres / static_cast<double>(samples);
  const double tip = group.runs.front().context.tip_radius_m;
  const double other = is_within ? radius + 2.0 * tip : radius - 2.0 * tip;
  if (other <= 0.0) return {};
  return std::string(
             "WARNING: nothing tells on which side of the tips the material lies: it is "
             "taken to lie ") +
         (is_within ? "within the circle (a pin)" : "around the circle (a bore)") + "; of a " +
         (is_within ? "bore" : "pin") + " the radius is " + text_of_length(other) +
         ". Say --touched-from " + (is_within ? "outside or inside" : "inside or outside") +
         "; a column material_side of strokes tells it too, and so do measured normals";
}

std::string note_of_unused_side(const ContactGroup& group, TouchedFrom touched_from) {
  const bool has_tip = std::any_of(group.runs.begin(), group.runs.end(), [](const ContactRun& run) {
    return run.context.tip_radius_m > 0.0;
  });
  return touched_from == TouchedFrom::Unknown || has_tip
             ? std::string()
             : "WARNING: --touched-from is not used: no sample is the centre of a round tip "
               "(--tip-radius, column tip_radius)";
}

std::string note_of_misfit(const v1::GivenClassAnswer& answer) {
  const v1::Recognition& fit = answer.recognition();
  if (fit.doubt() != v1::RECOGNITION_DOUBT_MISFIT || answer.residual_m().empty()) return {};
  // Of samples that were left out the residual is not told, or does not matter.
  int furthest = -1;
  for (int i = 0; i < answer.residual_m_size(); ++i) {
    const auto number = static_cast<std::uint32_t>(i) + 1;
    const auto& out = answer.left_out();
    if (std::find(out.begin(), out.end(), number) != out.end()) continue;
    if (furthest < 0 || std::abs(answer.residual_m(i)) > std::abs(answer.residual_m(furthest))) {
      furthest = i;
    }
  }
  const v1::Hypothesis& hypothesis = fit.hypotheses(0);
  return "WARNING: the residuals are larger than the stated noise can be (chi2 " +
         number(hypothesis.chi2()) + ", expected " + std::to_string(hypothesis.dof()) +
         "): the part is none of this class, or touches are bad, and the deviations do not hold. "
         "Sample " +
         std::to_string(furthest + 1) + " lies furthest off, by " +
         text_of_length(std::abs(answer.residual_m(furthest))) + " (--leave-out " +
         std::to_string(furthest + 1) + " sets it aside)";
}

}  // namespace palpate
