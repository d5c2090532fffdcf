// Closed spline parts, and strokes along them as a probe makes them.
#pragma once

#include <random>
#include <vector>

#include "core/part/closed_spline.h"
#include "core/recognition/samples/sample_memory.h"

namespace palpate::test {

/// The part of section 6 with five segments, as in sim/scenes/paper_closed_spline.textproto. About
/// 52 mm across.
ClosedSpline paper_part();

/// The spline of a regular polygon: all its segments are alike.
ClosedSpline symmetric_part(int points);

/// A stroke from curve parameter t0 over arc_m [m] (negative: against increasing t).
struct PartStroke {
  double t0 = 0.0;
  double arc_m = 0.0;
  int count = 111;
};

struct TouchedPart {
  std::vector<StoredPatch> patches;
  std::vector<std::vector<double>>
      t;  ///< true curve parameter of each sample, not reduced by the period
};

/// Samples at equal arc lengths along the part at that pose, with isotropic Gaussian noise of
/// `noise_m`, of which neighbours correlate by `correlation`; the samples state `sigma_m`. Tips
/// (radius 0 = none) are outside.
TouchedPart touch(const ClosedSpline& part, const Pose2& world_T_part,
                  const std::vector<PartStroke>& strokes, double noise_m, double sigma_m,
                  std::mt19937_64& rng, double tip_radius_m = 0.0, double correlation = 0.0);

/// Uniform in translation (within 1 m) and rotation.
Pose2 random_pose(std::mt19937_64& rng);

}  // namespace palpate::test
