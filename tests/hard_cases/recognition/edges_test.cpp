// Strokes over an edge of a part: two straight flanks with a fillet between them. A hyperbola with
// a vertex as tight fits them, and was RECOGNIZED in a quarter.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "core/curves/curve.h"
#include "core/curves/rounded_corner.h"
#include "core/numerics/probability/negligible.h"
#include "core/recognition/posterior/edges.h"
#include "core/recognition/recognizer.h"
#include "core/recognition/smooth/arcs.h"
#include "tests/support/answered_touches.h"
#include "tests/support/most_of_poisson.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

constexpr double kMillimetre = 1e-3;  // [m]

/// Once from one flank to the other; lengths in units of the spacing of samples.
std::vector<Vec2> over_edge(double before, double after, double radius, double turn,
                            std::mt19937_64& rng) {
  std::vector<Vec2> places;
  for (double s = -before + test::uniform(rng, 0.0, 1.0); s < radius * turn + after; s += 1.0) {
    const double angle = std::clamp(s / radius, 0.0, turn);
    const Vec2 normal(std::sin(angle), -std::cos(angle));
    places.push_back(radius * normal + (s - radius * angle) * left_of(normal));
  }
  return places;
}

/// `tip_radius`: over that of the fillet that its centre goes round; 0 = a point.
Recognition stroked_over_edge(int strokes, bool stated, double tip_radius, std::mt19937_64& rng) {
  const double spacing_m = test::uniform(rng, 0.3, 0.8) * kMillimetre;
  const double radius = test::log_uniform(rng, 0.02, 3.0);
  const double turn = test::uniform(rng, 0.3, 2.5);
  const double sigma_m = test::log_uniform(rng, 1e-3, 2e-2) * kMillimetre;
  const Pose2 pose = test::pose_within(rng, 0.05);
  Recognizer recognizer;
  for (int p = 0; p < strokes; ++p) {
    const double before = test::uniform(rng, 15.0, 50.0);
    const double after = test::uniform(rng, 15.0, 50.0);
    std::vector<ContactSample> samples;
    for (const Vec2& place : over_edge(before, after, radius, turn, rng)) {
      samples.push_back({pose * Vec2(spacing_m * place) + test::normal_pair(rng, sigma_m),
                         stated ? sigma_m : 0.0, 0});
    }
    PatchContext context;
    context.patch = static_cast<std::uint32_t>(p);
    context.tip_radius_m = tip_radius * radius * spacing_m;
    context.material_side = tip_radius > 0.0 ? MaterialSide::Left : MaterialSide::Unspecified;
    recognizer.add(context, samples);
  }
  return recognizer.recognize();
}

TEST(Edges, AreOfNoClass) {
  std::mt19937_64 rng = test::test_rng();
  int recognized = 0;
  double stated = 0.0;
  int none_first = 0;
  const int scenes = test::stress_count(200);
  for (int i = 0; i < scenes; ++i) {
    const Recognition answer = stroked_over_edge(1 + i % 3, i % 2 == 0, 0.0, rng);
    const bool is_wrong = test::is_recognized(answer);
    recognized += is_wrong ? 1 : 0;
    stated += is_wrong ? test::stated_doubt(answer) : 0.0;
    if (is_wrong) {
      std::cout << i << ": " << test::said(answer) << "\n";
    }
    none_first += answer.hypotheses.front().shape.curve_class == CurveClass::Unclassified ? 1 : 0;
  }
  std::cout << "of " << scenes << " RECOGNIZED as a class " << recognized
            << ", of no class most probably " << none_first << "\n";
  EXPECT_LE(recognized, test::most_of_poisson(stated));
  if (test::counts_tell()) {
    // A sharp hyperbola that fits as well is half as probable beforehand: the edges are then the
    // more probable in two of three.
    EXPECT_GE(none_first, 2 * scenes / 3);
  }
}

// What a tip's centre goes round is a corner too, with a tip as large as its radius on a sharp
// edge. The search for classes, none of which fits, may take all work: edges are sought before.
TEST(Edges, UnderATipAreOfNoClassWhateverTheSearchTakes) {
  std::mt19937_64 rng = test::test_rng();
  int none_first = 0;
  const int scenes = test::stress_count(60);
  for (int i = 0; i < scenes; ++i) {
    const Recognition answer =
        stroked_over_edge(1 + i % 3, i % 2 == 0, test::uniform(rng, 0.3, 1.0), rng);
    EXPECT_FALSE(test::is_recognized(answer)) << i << ": " << test::said(answer);
    none_first += answer.hypotheses.front().shape.curve_class == CurveClass::Unclassified ? 1 : 0;
  }
  if (test::counts_tell()) {
    EXPECT_GE(none_first, 2 * scenes / 3);
  }
}

// Two edges beside each other within the noise would each take the samples on its side, and leave a
// third of the chi-square. A probe does not go from the one to the other and back with each sample.
TEST(Edges, DenseNoisyStrokesOfACubicAreNotBetweenTwo) {
  std::mt19937_64 rng = test::test_rng();
  const int scenes = test::stress_count(100);
  int none = 0;
  double stated = 0.0;
  for (int i = 0; i < scenes; ++i) {
    constexpr double kSigma = 0.3 * kMillimetre;
    const double length_m = test::uniform(rng, 8.0, 25.0) * kMillimetre;
    const double sag_m = test::uniform(rng, 2.0, 10.0) * kSigma;  // at its ends, from its tangent
    const Pose2 pose = test::pose_within(rng, 0.2);
    Recognizer recognizer;
    for (std::uint32_t p = 0; p < 3; ++p) {
      const double begin = 0.3 * p - 0.8;
      std::vector<ContactSample> samples;
      constexpr int kSamples = 200;
      for (int k = 0; k < kSamples; ++k) {
        const double x = begin + static_cast<double>(k) / kSamples;
        const Vec2 place(length_m * x, sag_m * x * x * x);
        samples.push_back({pose * place + test::normal_pair(rng, kSigma), kSigma, 0});
      }
      PatchContext context;
      context.patch = p;
      recognizer.add(context, samples);
    }
    const Recognition answer = recognizer.recognize();
    if (answer.status == RecognitionStatus::Recognized &&
        answer.shape.curve_class == CurveClass::Unclassified) {
      ++none;
      stated += test::stated_doubt(answer);
      std::cout << i << ": " << test::said(answer) << "\n";
    }
  }
  EXPECT_LE(none, test::most_of_poisson(stated));
}

/// Of each coordinate of the corner, by distances of all samples.
Eigen::Matrix<double, 1, kEdgesCoordinates> information_of(const RoundedCorner& corner,
                                                           std::span<const FitPoint> points) {
  Eigen::Matrix<double, 1, kEdgesCoordinates> sum = decltype(sum)::Zero();
  for (const FitPoint& point : points) {
    RoundedCorner::Row row = point.inverse_sigma * corner.distance(point.position).gradient;
    row[4] *= corner.radius;  // by its logarithm
    sum += row.cwiseAbs2();
  }
  return sum;
}

// What the edges cost of their prior rests on it.
TEST(Edges, HaveTheInformationOfTheCornerTold) {
  std::mt19937_64 rng = test::test_rng();
  int told = 0;
  for (int i = 0; i < test::stress_count(50); ++i) {
    constexpr double kSigma = 0.01;  // of the spacing of samples
    constexpr double kRadius = 8.0;
    StoredPatch patch;
    for (const Vec2& place : over_edge(40.0, 30.0, kRadius, test::uniform(rng, 0.8, 2.0), rng)) {
      patch.samples.push_back({place + test::normal_pair(rng, kSigma), kSigma});
    }
    const Arcs arcs = smooth_arcs(make_fit_data({&patch, 1}, 0.0));
    WorkBudget work;
    const auto edges = edges_of(arcs, std::numeric_limits<double>::infinity(), work);
    if (!edges) {
      continue;
    }
    ++told;
    const auto of_all = information_of(edges->corner, arcs.data.points);
    for (int k = 0; k < kEdgesCoordinates; ++k) {
      // Points between edge and arc are of either: a few of the 16 on the arc.
      EXPECT_NEAR(edges->information(k, k) / of_all[k], 1.0, 0.25) << i << " coordinate " << k;
    }
  }
  EXPECT_GT(told, 0);
}

/// Samples of a semi-cubical parabola, stroked over the cusp. `chi2` receives what the curve leaves
/// of them, each at its place.
StoredPatch stroked_over_cusp(const Curve& curve, double t_end, double sigma_m,
                              std::mt19937_64& rng, double* chi2) {
  const double from = -test::uniform(rng, 0.2, 1.0) * t_end;
  const double to = test::uniform(rng, 0.2, 1.0) * t_end;
  const double length = arc_length(curve, from, to);
  const int count = static_cast<int>(test::uniform(rng, 30.0, 120.0));
  StoredPatch patch;
  for (int i = 0; i < count; ++i) {
    const double t = parameter_at_arc_length(curve, from, length * i / (count - 1));
    const Vec2 noise = test::normal_pair(rng, sigma_m);
    const double away = cross(derivatives(curve, t).first.normalized(), noise) / sigma_m;
    *chi2 += away * away;
    patch.samples.push_back({position(curve, t) + noise, sigma_m});
  }
  return patch;
}

// The arms of a narrow cusp lie within the noise of one another for a while. With each sample on
// the nearest of two edges, these left far less than the cusp that was touched.
TEST(Edges, LeaveNoLessThanANarrowCusp) {
  std::mt19937_64 rng = test::test_rng();
  constexpr double kSize = 0.02;  // [m]
  double less = 0.0;
  int scenes = 0;
  for (int i = 0; i < test::stress_count(300); ++i) {
    const double a = test::uniform(rng, 0.05, 0.2) / std::sqrt(kSize);
    const Curve curve = make_curve(CurveClass::SemiCubicalParabola, {a, 0.0, 0.0}).value();
    const double sigma_m = 0.01 * kSize;
    double of_cusp = 0.0;
    const StoredPatch patch = stroked_over_cusp(curve, std::sqrt(kSize), sigma_m, rng, &of_cusp);
    const Arcs arcs = smooth_arcs(make_fit_data({&patch, 1}, 0.0));
    WorkBudget work;
    const auto edges = edges_of(arcs, std::numeric_limits<double>::infinity(), work);
    if (edges) {
      ++scenes;
      less += std::max(of_cusp - edges->chi2, 0.0);
    }
  }
  ASSERT_GT(scenes, 0);
  // Each coordinate takes a square of the noise, and so does the place of the change.
  EXPECT_LE(less, most_of_noise((kEdgesCoordinates + 1.0) * scenes));
}

}  // namespace
}  // namespace palpate
