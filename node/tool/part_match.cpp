#include "node/tool/part_match.h"

#include <map>
#include <utility>

#include "core/part/segment_belonging.h"
#include "node/files/text_format.h"
#include "node/wire/convert.h"
#include "palpate/v1/scene.pb.h"

namespace palpate {
namespace {

/// Placements are searched for all along the part, which takes about ten milliseconds per segment.
/// A part of one metre may thus have a segment every 4 mm.
constexpr std::size_t kMostControlPoints = 256;

/// At this distance the rounding of a coordinate is 2 nm, the resolution of the finest probes.
constexpr double kFarthest_m = 1e7;

/// One patch for each probe and patch number, in the order of their first sample.
std::vector<StoredPatch> patches_of(const ContactGroup& group) {
  std::vector<StoredPatch> patches;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> index_of;
  for (const ContactRun& run : group.runs) {
    const auto [found, is_new] =
        index_of.try_emplace({run.context.probe, run.context.patch}, patches.size());
    if (is_new) {
      patches.emplace_back().context = run.context;
    }
    for (const ContactSample& sample : run.samples) {
      patches[found->second].samples.push_back({sample.position_m, sample.sigma_m, 1.0});
    }
  }
  return patches;
}

v1::PartMatchStatus to_wire(SegmentMatchStatus status) {
  switch (status) {
    case SegmentMatchStatus::TooFewSamples:
      return v1::PART_MATCH_STATUS_TOO_FEW_SAMPLES;
    case SegmentMatchStatus::NoMatch:
      return v1::PART_MATCH_STATUS_NO_MATCH;
    case SegmentMatchStatus::Ambiguous:
      return v1::PART_MATCH_STATUS_AMBIGUOUS;
    case SegmentMatchStatus::Determined:
      return v1::PART_MATCH_STATUS_DETERMINED;
  }
  return v1::PART_MATCH_STATUS_UNSPECIFIED;
}

v1::PartMatchDoubt to_wire(SegmentMatchDoubt doubt) {
  switch (doubt) {
    case SegmentMatchDoubt::None:
      return v1::PART_MATCH_DOUBT_UNSPECIFIED;
    case SegmentMatchDoubt::SeveralPlacements:
      return v1::PART_MATCH_DOUBT_SEVERAL_PLACEMENTS;
    case SegmentMatchDoubt::SlidesAlong:
      return v1::PART_MATCH_DOUBT_SLIDES_ALONG;
  }
  return v1::PART_MATCH_DOUBT_UNSPECIFIED;
}

void to_wire(const PartPlacement& placement, std::span<const StoredPatch> patches,
             const ContactGroup& group, v1::PartPlacement& message) {
  message.set_probability(placement.probability);
  to_wire(placement.world_T_part, *message.mutable_pose());
  palpate::to_wire(placement.covariance, *message.mutable_covariance());
  message.set_chi2(placement.chi2);
  message.set_dof(placement.dof);
  message.set_misfit_chi2(placement.misfit_chi2);
  message.set_misfit_dof(placement.misfit_dof);
  message.set_slide_sd_m(placement.slide_sd_m);
  message.set_nonlinearity(placement.nonlinearity);
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const PatchOnPart& place = placement.patches[p];
    v1::PatchOnPart& patch = *message.add_patches();
    patch.set_probe(group.probes[patches[p].context.probe]);
    patch.set_patch(patches[p].context.patch);
    patch.set_segment(static_cast<std::uint32_t>(place.segment));
    patch.set_along_increasing_t(place.along_increasing_t);
    for (std::size_t i = 0; i < place.samples.size(); ++i) {
      patch.add_t(static_cast<double>(place.samples[i].segment) + place.samples[i].u);
      if (place.samples[i].is_outlier) {
        patch.add_outliers(static_cast<std::uint32_t>(i));
      }
    }
    for (const std::size_t i : place.beyond) {
      patch.add_beyond(static_cast<std::uint32_t>(i));
    }
  }
}

void to_wire(const SegmentBelonging& belonging, v1::PatchJoints& message) {
  message.set_begin(static_cast<std::uint32_t>(belonging.begin));
  message.set_end(static_cast<std::uint32_t>(belonging.end));
  for (const SegmentJoint& found : belonging.joints) {
    v1::PatchJoint& joint = *message.add_joints();
    joint.set_index(static_cast<std::uint32_t>(found.index));
    joint.set_earliest(static_cast<std::uint32_t>(found.earliest));
    joint.set_latest(static_cast<std::uint32_t>(found.latest));
    joint.set_x_m(found.position_m.x());
    joint.set_y_m(found.position_m.y());
  }
}

}  // namespace

Result<ClosedSpline> read_part(const std::string& path) {
  const Result<std::string> text = read_file(path);
  return text ? parse_part(*text.value, path) : Result<ClosedSpline>::fail(text.error);
}

Result<ClosedSpline> parse_part(const std::string& text, const std::string& path) {
  using Loaded = Result<ClosedSpline>;
  v1::Scene scene;
  if (const std::string error = parse_text(text, path, scene); !error.empty()) {
    return Loaded::fail(in_words(
        error, path, "this is no line of a scene file, such as paper_closed_spline.textproto"));
  }
  if (!scene.has_closed_spline()) {
    return Loaded::fail(path + ": has no closed_spline: only such parts can be matched");
  }
  std::vector<Vec2> points;
  for (const v1::ScenePoint& point : scene.closed_spline().control_points()) {
    points.emplace_back(point.x_m(), point.y_m());
    const double farthest = points.back().cwiseAbs().maxCoeff();
    if (!points.back().allFinite() || farthest > kFarthest_m) {
      return Loaded::fail(path + ": closed_spline.control_points[" +
                          std::to_string(points.size() - 1) + "]: a coordinate is " +
                          (points.back().allFinite() ? "beyond 10,000 km" : "not finite"));
    }
  }
  if (points.size() < ClosedSpline::kFewestPoints) {
    return Loaded::fail(path + ": closed_spline.control_points: there must be at least four");
  }
  if (points.size() > kMostControlPoints) {
    return Loaded::fail(path + ": closed_spline.control_points: there may be at most " +
                        std::to_string(kMostControlPoints));
  }
  return Loaded::ok(ClosedSpline(std::move(points)));
}

v1::PartMatch match_part(const ContactGroup& group, const ClosedSpline& part,
                         const SegmentMatchOptions& options) {
  const std::vector<StoredPatch> patches = patches_of(group);
  const SegmentMatch match = match_segment(part, patches, options);
  v1::PartMatch message;
  message.set_source(group.file);
  message.set_group(group.name);
  message.set_object(group.object);
  message.set_status(to_wire(match.status));
  message.set_doubt(to_wire(match.doubt));
  message.set_sigma_m(match.sigma_m);
  for (const double probability : match.segment_probability) {
    message.add_segment_probability(probability);
  }
  for (const PartPlacement& placement : match.placements) {
    to_wire(placement, patches, group, *message.add_placements());
  }
  for (const StoredPatch& patch : patches) {
    v1::PatchJoints& joints = *message.add_joints();
    joints.set_probe(group.probes[patch.context.probe]);
    joints.set_patch(patch.context.patch);
    to_wire(longest_segment(patch, options.sigma_m), joints);
  }
  return message;
}

}  // namespace palpate
