// A part match as text for a person to read.
#include <algorithm>
#include <cmath>

#include "node/files/quantity.h"
#include "node/tool/part_match.h"

namespace palpate {
namespace {

std::string verdict(const v1::PartMatch& match) {
  switch (match.status()) {
    case v1::PART_MATCH_STATUS_TOO_FEW_SAMPLES:
      return match.sigma_m() > 0.0
                 ? "too few samples to place the part"
                 : "too few samples to place the part: nothing shows their noise, state it "
                   "(--sigma, column sigma)";
    case v1::PART_MATCH_STATUS_NO_MATCH:
      return "no match: nowhere on the part do the samples fit";
    case v1::PART_MATCH_STATUS_DETERMINED:
      return "determined";
    default:
      return match.doubt() == v1::PART_MATCH_DOUBT_SLIDES_ALONG
                 ? "ambiguous: the part may slide along under the samples"
                 : "ambiguous: several placements remain plausible";
  }
}

/// Indices as ranges, e.g. "0-17, 94-110".
template <typename Indices>
std::string ranges(const Indices& indices) {
  std::string text;
  for (int i = 0; i < indices.size();) {
    int last = i;
    while (last + 1 < indices.size() && indices[last + 1] == indices[last] + 1) {
      ++last;
    }
    text += text.empty() ? "" : ", ";
    text += std::to_string(indices[i]);
    if (last > i) {
      text += "-";
      text += std::to_string(indices[last]);
    }
    i = last + 1;
  }
  return text;
}

std::string pose_text(const v1::PartPlacement& placement) {
  const auto sigma = [&](int i) { return std::sqrt(std::max(placement.covariance(4 * i), 0.0)); };
  const v1::Pose2& pose = placement.pose();
  const LengthUnit unit = length_unit_for(std::max(std::abs(pose.x_m()), std::abs(pose.y_m())));
  const std::string name(unit.name);
  return "x " + with_sigma(pose.x_m() * unit.per_m, sigma(0) * unit.per_m) + " " + name + ", y " +
         with_sigma(pose.y_m() * unit.per_m, sigma(1) * unit.per_m) + " " + name + ", theta " +
         with_sigma(pose.theta_rad() * kDegrees, sigma(2) * kDegrees) + " deg";
}

void add_patch(const v1::PatchOnPart& patch, std::string& text) {
  const bool is_touch = patch.t_size() == 1;
  text += (is_touch ? "  touch " : "  patch ") + patch.probe() + "/" +
          std::to_string(patch.patch()) + "    segment " + std::to_string(patch.segment());
  if (is_touch) {
    add_row(text, ", t %.4f", patch.t(0));
  } else if (patch.t_size() > 0) {
    add_row(text, ", t %.4f to %.4f", patch.t(0), patch.t(patch.t_size() - 1));
  }
  if (patch.beyond_size() > 0) {
    text += "; beyond a joint: samples " + ranges(patch.beyond());
  }
  if (patch.outliers_size() > 0) {
    text += "; spikes: " + ranges(patch.outliers());
  }
  text += "\n";
}

void add_joints(const v1::PatchJoints& patch, std::string& text) {
  text +=
      "  joints of " + patch.probe() + "/" + std::to_string(patch.patch()) + " without the model: ";
  if (patch.joints_size() == 0) {
    text += "none seen\n";
    return;
  }
  for (int j = 0; j < patch.joints_size(); ++j) {
    const v1::PatchJoint& joint = patch.joints(j);
    add_row(text, "%sbefore sample %u (%u to %u)", j > 0 ? "; " : "", joint.index(),
            joint.earliest(), joint.latest());
  }
  text += "\n";
}

}  // namespace

std::string part_match_text(const v1::PartMatch& match, bool noise_is_stated) {
  std::string text = verdict(match) + "\n";
  if (!noise_is_stated && match.placements_size() > 0) {
    text += "  noise        sigma " + text_of_length(match.sigma_m()) +
            ", estimated: +- counts white noise alone, a probe's drift or lobes are not in it\n";
  }
  for (int p = 0; p < match.placements_size(); ++p) {
    const v1::PartPlacement& placement = match.placements(p);
    const LengthUnit unit = length_unit_for(placement.slide_sd_m());
    add_row(text, "  placement %d  probability %.4g, chi2 %.4g on %d, misfit %.3g on %d\n", p + 1,
            placement.probability(), placement.chi2(), placement.dof(), placement.misfit_chi2(),
            placement.misfit_dof());
    text += "  part         " + pose_text(placement) + "\n";
    text += "  along it     +- " + number(placement.slide_sd_m() * unit.per_m) + " " +
            std::string(unit.name) + "\n";
    for (const v1::PatchOnPart& patch : placement.patches()) {
      add_patch(patch, text);
    }
  }
  if (match.segment_probability_size() > 0) {
    text += "  segments    ";
    for (int i = 0; i < match.segment_probability_size(); ++i) {
      add_row(text, " %d: %.3g", i, match.segment_probability(i));
    }
    text += "\n";
  }
  for (const v1::PatchJoints& patch : match.joints()) {
    if (patch.end() > 1) {  // a single touch joins nothing
      add_joints(patch, text);
    }
  }
  return text;
}

}  // namespace palpate
