// The contact points of one object, ready for fitting: centred and scaled.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "core/curves/pose2.h"
#include "core/recognition/samples/sample_memory.h"

namespace palpate {

/// Largest noise, as a fraction of the half extent, with which anything is measured. If the noise
/// is not stated, RECOGNIZED needs eight places (fewest_places.h), three more than a conic has
/// unknowns. So random points lie within the noise of some conic with a probability of about its
/// third power: one in a million.
inline constexpr double kLargestNoise = 0.01;

/// Least noise, as a fraction of the half extent, where nobody states it: an atom's width on a part
/// 200 mm across. Points of a formula have less, but no probe does; taken to their last digit they
/// would cost all the work that an answer may take.
inline constexpr double kFinest = 1e-9;

/// Of the half extent: points that fit to this are taken as exact where nobody states their noise.
inline constexpr double kExact = 1e-6;

/// One contact point in normalised coordinates (world = frame * (scale * normalised)).
struct FitPoint {
  Vec2 position = Vec2::Zero();  ///< normalised
  Vec2 tangent = Vec2::Zero();   ///< direction of travel, unit; zero if unknown
  double inverse_sigma = 1.0;    ///< 1 / (noise in normalised units)
  double offset = 0.0;           ///< tip radius in normalised units; 0 = surface point
  /// Measured surface normal, unit, in the frame. Only for single touches, and only if the noise of
  /// every point is known. (Along a stroke the positions show the direction.)
  Vec2 normal = Vec2::Zero();
  double inverse_normal_sigma = 0.0;  ///< 1 / (standard deviation of its direction [rad]); 0 = none
  /// Ratio of the noise along the curve to that across it, which is inverse_sigma's.
  double along_over_across = 1.0;
  /// Standard deviation of the tangent's direction, which matters where a tip is removed; infinite
  /// if no smooth model gives it. [rad]
  double tangent_sigma = std::numeric_limits<double>::infinity();
};

/// What a probe states in addition about a point, if every noise is known; normalised, in the
/// frame. What an answer uses is taken out: the rest is not used.
struct PointDetail {
  /// Covariance [xx, xy, yy] of the position; zeros = alike in all directions.
  Eigen::Vector3d covariance = Eigen::Vector3d::Zero();
  /// Measured normal of a point in a stroke, as FitPoint's of a single touch; 0 = none.
  Vec2 normal = Vec2::Zero();
  double inverse_normal_sigma = 0.0;
  double contacts = 1.0;  ///< that the point stands for
  /// Direction of the smooth model's path, as far as noise does not turn it; zero where it does.
  Vec2 travel = Vec2::Zero();
  double off_path = 0.0;  ///< distance from that path, on the left of travel

  bool says_more() const { return covariance.x() > 0.0 || inverse_normal_sigma > 0.0; }
};

/// Points of all patches of an object, in the frame of their principal axes and in units of their
/// half extent. So starts, solver tolerances and roundings are the same at every scale and
/// position.
struct FitData {
  std::vector<FitPoint> points;
  std::vector<PatchSpan> patches;
  Pose2 frame;         ///< centre of the points' box, x along the longer principal axis
  double scale = 1.0;  ///< half the longer side of that box [m]
  /// Whether the noise of every point is stated. If not, all points have noise 1 (normalised) over
  /// the root of their weight: only ratios count until the noise is estimated.
  bool noise_is_stated = true;
  /// Least noise, normalised, where nobody states it: what the rounding of the readings leaves
  /// (local/reading_step.h), or kFinest.
  double reading_noise = 0.0;
  std::vector<PointDetail> details = {};  ///< one per point; empty if no point has any
  /// True if the normals of points in strokes are among the residuals.
  bool normals_along_strokes = false;

  std::span<const FitPoint> patch(std::size_t i) const {
    return std::span(points).subspan(patches[i].begin, patches[i].size());
  }
};

/// A point of `data` in the world. [m]
inline Vec2 world_m(const FitData& data, const FitPoint& point) {
  return data.frame * Vec2(data.scale * point.position);
}

/// Converts stored samples to fit points. `default_sigma_m`: noise of samples that state none; 0 =
/// not stated [m]. Noise below the rounding of the coordinates is raised to it. Tip radii become
/// offsets. Empty patches are left out. Normals and covariances are kept only if every noise is
/// stated.
FitData make_fit_data(std::span<const StoredPatch> patches, double default_sigma_m);

/// Whether no two of the points are neighbours along a stroke. (A touch that was set aside has left
/// an empty patch.)
bool all_lie_apart(const FitData& data);

/// Ratio of the noise of a contact to that of a stored sample (a mean of several in long patches);
/// 1 if none are merged.
double noise_over_means(std::span<const StoredPatch> patches, double default_sigma_m);

/// Number of residuals: one per point, plus one per normal. O(patches).
std::size_t residual_count(const FitData& data);

/// The data without some of their points: one flag per point. Each patch stays, if an empty one.
FitData without_points(const FitData& data, const std::vector<bool>& is_out);

/// Number of contacts with a detail that is not used.
std::size_t contacts_with_details(const FitData& data);

/// Root mean square of the points' noise, normalised. Needs at least one point.
double rms_sigma(const FitData& data);

/// Mean distance of points next to one another in a patch, normalised; 0 if there are none.
double mean_step(const FitData& data);

/// The smallest noise of any point, normalised; infinite without points.
double least_sigma(std::span<const FitPoint> points);

/// The chi-square that noise of size kLargestNoise leaves.
double most_chi2_of_noise(std::span<const FitPoint> points);

/// True if any point is the centre of a tip.
bool has_tips(std::span<const FitPoint> points);

/// The largest offset; 0 without tips.
double largest_offset(std::span<const FitPoint> points);

/// Rounding error of the coordinates, normalised: no noise is smaller.
double rounding_level(const FitData& data);

}  // namespace palpate
