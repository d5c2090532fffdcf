// The contact points of one object, made ready for fitting: spikes aside, centred and scaled.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/curves/pose2.h"
#include "core/recognition/samples/sample_memory.h"

namespace palpate {

/// Of the half extent: beyond this noise nothing is measured. The fewest places that are RECOGNIZED
/// where nobody states it (recognizer.cpp) are three more than a conic has parameters, so that
/// points anywhere lie within the noise of some conic with a probability of about its third power:
/// one in a million.
inline constexpr double kLargestNoise = 0.01;

/// One contact point in normalised coordinates (world = frame * (scale * normalised)).
struct FitPoint {
  Vec2 position = Vec2::Zero();  ///< normalised
  Vec2 tangent = Vec2::Zero();   ///< direction of travel, unit; zero where it is not known
  double inverse_sigma = 1.0;    ///< 1 / (noise in normalised units)
  double offset = 0.0;           ///< tip radius in normalised units; 0 = surface point
  /// Measured normal of the surface, unit, in the frame: of a touch alone in its patch whose noise
  /// is known. (Along a stroke the positions tell the direction.)
  Vec2 normal = Vec2::Zero();
  double inverse_normal_sigma = 0.0;  ///< 1 / (deviation of its direction [rad]); 0 = none
  double along_over_across = 1.0;  ///< noise along the curve over that across it, inverse_sigma's
  /// Deviation of the tangent, along which a tip is taken off [rad]; infinite where no smooth model
  /// tells it.
  double tangent_sigma = std::numeric_limits<double>::infinity();
};

/// What a probe says more of a point, where every noise is known; normalised, in the frame. What
/// counts in an answer is taken out: what is left does not.
struct PointDetail {
  /// [xx, xy, yy] of the position's noise; zeros = alike in all directions.
  Eigen::Vector3d covariance = Eigen::Vector3d::Zero();
  /// Measured normal of a point in a stroke, as FitPoint's of a touch alone; 0 = none.
  Vec2 normal = Vec2::Zero();
  double inverse_normal_sigma = 0.0;
  double contacts = 1.0;  ///< that the point stands for

  bool says_more() const { return covariance.x() > 0.0 || inverse_normal_sigma > 0.0; }
};

/// Points of all patches of an object. Normalised to their principal axes and extent, so that
/// starts, solver tolerances and roundings are the same at every scale and wherever the object
/// lies.
struct FitData {
  std::vector<FitPoint> points;
  std::vector<PatchSpan> patches;
  Pose2 frame;         ///< centre of the points' extents, x along the longer principal axis
  double scale = 1.0;  ///< half extent of the points [m]
  std::vector<PointDetail> details = {};  ///< of the points; empty where none says more
  /// The normals of points in strokes are the points' own: they leave residuals too.
  bool normals_along_strokes = false;

  std::span<const FitPoint> patch(std::size_t i) const {
    return std::span(points).subspan(patches[i].begin, patches[i].size());
  }
};

/// The samples in memory as fit points. `default_sigma_m` is the noise of samples that bring none;
/// `sigma_known` receives whether every point then has one (points without get 1, normalised: only
/// their ratios count until the noise is estimated). A noise below the rounding of the coordinates
/// is raised to it. Tip radii become offsets. Empty patches are left out. Normals and covariances
/// are set where every point's noise is known.
FitData make_fit_data(std::span<const StoredPatch> patches, double default_sigma_m,
                      bool* sigma_known);

/// Noise of a contact over that of a stored sample, which is the mean of several in a long patch; 1
/// where none are merged.
double noise_over_means(std::span<const StoredPatch> patches, double default_sigma_m);

/// How many measurements a curve leaves residuals of: a place a point, and the normals. O(patches).
std::size_t residual_count(const FitData& data);

/// Contacts with a detail that does not count.
std::size_t contacts_with_details(const FitData& data);

/// Root mean square of the points' noise, in normalised units. At least one point.
double rms_sigma(const FitData& data);

/// The least noise of any of the points, normalised; infinite without points.
double least_sigma(std::span<const FitPoint> points);

/// The chi-square that noise of kLargestNoise leaves.
double most_chi2_of_noise(std::span<const FitPoint> points);

/// Whether any of the points is the centre of a tip.
bool has_tips(std::span<const FitPoint> points);

/// Rounding of the data's coordinates, in normalised units: no noise is smaller than that.
double rounding_level(const FitData& data);

}  // namespace palpate
